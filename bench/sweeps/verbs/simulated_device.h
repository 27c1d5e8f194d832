#pragma once

#include <string>
#include <vector>

#include "plan/sweep_plan.h"

namespace kerf::bench {

/// `device`, a URI that begins with "sim:", and `device_seed`, of what it draws.
[[nodiscard]] std::vector<SweepInput> simulated_device_inputs();

/// The URI of a cell, with its seed. @throws std::invalid_argument for a device that is not simulated: a
/// sweep moves no hardware.
[[nodiscard]] std::string simulated_device(const SweepCell& cell);

}  // namespace kerf::bench

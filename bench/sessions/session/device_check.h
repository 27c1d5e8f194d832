#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "protocol/protocol.h"

namespace kerf::bench {

/// Whether every sample of a protocol, at the ends of its levels too, can be rendered on a device: its axes
/// are there; all laws of a tissue together, as a session computes them, take at most half of a period in
/// 99.9 % of the ticks; and, on a simulated device in virtual time, no law fails and none is cut to the limit
/// of the device in more than one tick in twenty, where a session would compare limits and not laws.
/// @return what is worth saying and no reason to refuse: a law that has a limit cycle in a firm grip.
/// @throws std::invalid_argument that names the sample and what is wrong; drivers::DeviceError.
[[nodiscard]] std::vector<std::string> check_samples(const Protocol& protocol, const std::string& device_uri,
                                                     const std::atomic<bool>& stop);

}  // namespace kerf::bench

#pragma once

#include <cstdint>

#include "program/verb.h"

namespace kerf::bench {

/// What `kerf stability` studies.
enum class StabilityMode : std::uint8_t { walls, law, plane, several, z_width, controllers, cases };

/// Refuses the options that say nothing to a study. @throws std::invalid_argument in a line that names the
/// option, and what it is for.
void refuse_idle_options(const RefuseIdle& refuse, StabilityMode mode);

}  // namespace kerf::bench

#pragma once

#include <cstdint>

#include "program/verb.h"

namespace kerf::bench {

/// What a recording is played as.
enum class ReplayMode : std::uint8_t { through, table, path };

/// An option that was given to a mode that has no use for it would otherwise be passed over in silence.
/// @throws std::invalid_argument that says where it belongs.
void refuse_options_of_others(ReplayMode mode, const RefuseIdle& refuse_idle);

}  // namespace kerf::bench

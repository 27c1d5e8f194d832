#pragma once

#include <cstddef>
#include <vector>

#include "protocol/felt_level.h"
#include "sealed/session_store.h"

namespace kerf::bench {

/// What each slot of a trial was felt like. Vibration is that of stretches without a switch, `ramp_s` after
/// the slot was switched to, and not known where none is as long as a window. All of a trial without a trace,
/// and of a slot without a force that can be felt, is not known.
[[nodiscard]] std::vector<FeltLevel> slot_levels(const RecordedTrial& trial, const Protocol& protocol);

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sealed/session_store.h"

namespace kerf::bench {

/// A trial as it is sealed: 4,096 bytes of JSON, filled up with blanks, then its ticks, little-endian and not
/// compressed. So its length tells how long the trial took, and nothing of what was played or answered.
/// @throws std::invalid_argument: more names of axes and channels than fit.
[[nodiscard]] std::vector<std::uint8_t> trial_bytes(const RecordedTrial& trial);

/// The way back, with or without its trace. @throws std::invalid_argument: it is none.
enum class TraceToo { no, yes };
[[nodiscard]] RecordedTrial trial_from(std::span<const std::uint8_t> bytes, TraceToo trace);

}  // namespace kerf::bench

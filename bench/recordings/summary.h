#pragma once

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// What is in a recording, as `kerf info --json` and `kerf import --json` give it: samples, duration_s,
/// rate_hz, gaps, channels with unit, min and max, and warnings.
[[nodiscard]] nlohmann::ordered_json recording_summary(const schema::Recording& recording);

}  // namespace kerf::bench

#pragma once

#include <limits>
#include <string_view>
#include <vector>

#include "scene/motion.h"
#include "scene/read_trajectory.h"

namespace kerf::bench {

/// What a file may say of strokes under `from`, `to`, `stroke` and `pause`.
struct StrokeFormat {
  std::string_view unit;       ///< of positions
  StrokesToAndFro standard{};  ///< durations that are not given
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double shortest_s = 0.001;  ///< of a stroke
  double longest_s = longest_motion_s;
  double longest_pause_s = longest_motion_s;
};

/// @throws std::invalid_argument with file, line, found and expected.
[[nodiscard]] StrokesToAndFro read_strokes(const Place& place, const toml::table& table,
                                           const StrokeFormat& format);

/// One axis of a motion: `kind`, `axis` (one of those, without it the first) and what the kind asks for.
/// docs/regress.md has the kinds. @throws as above.
[[nodiscard]] ScriptedAxis read_scripted_axis(const Place& place, const toml::table& table,
                                              const std::vector<models::LawAxis>& axes);

}  // namespace kerf::bench

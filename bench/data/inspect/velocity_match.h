#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "signal/blocked_values.h"

namespace kerf::bench {

/// One axis as it was recorded.
struct RecordedMotion {
  const BlockedValues& time_s;
  const BlockedValues& position;
  const BlockedValues& velocity;
  double period_s = 0.0;        ///< usual step of the time
  double position_noise = 0.0;  ///< from row to row
  double position_range = 0.0;
};

/// What a recorded velocity is of dx/dt.
struct VelocityMatch {
  double gain = 0.0;             ///< velocity per dx/dt, by least squares, at the lag
  double offset = 0.0;           ///< by which the velocity is more than gain times dx/dt
  double share_of_offset = 0.0;  ///< its size in usual speeds (root mean square) times the gain
  double correlation = 0.0;      ///< of both at the lag
  double correlation_now = 0.0;  ///< without a lag
  double lag_s = 0.0;    ///< by which the velocity comes later; looked for where it does not follow now
  std::size_t ways = 0;  ///< that were compared and do not overlap
};

/// Holds ways against integrals of the velocity over the same rows, which noise, irregular times and few rows
/// a stroke leave what they are, where the slopes of a noisy position would be noise. Ways are of 1, 2, 4 ...
/// rows, those by which both go together best; a lag is looked for up to 1 s. Nothing is compared over gaps
/// and jumps. Unknown where fewer than 20 ways exceed eight times the noise, as at rest.
[[nodiscard]] std::optional<VelocityMatch> velocity_match(const RecordedMotion& motion);

/// What is wrong with a velocity, in words after its name; empty where nothing is. A lag as filters make it
/// (0.1 s, two rows) is nothing, and neither is a gain of 2/3 to 1.5.
[[nodiscard]] std::string velocity_doubt(const VelocityMatch& match, const std::string& position_unit,
                                         double period_s);

}  // namespace kerf::bench

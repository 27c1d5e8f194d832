#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <kerf/identification/output_error.h>
#include <kerf/identification/shots.h>

namespace kerf::identification {

/// The standard deviation of the delay from tick to tick, with its interval of 95 % [s].
struct DelayJitter {
  double value_s = 0.0;
  double lower_s = 0.0;
  double upper_s = 0.0;
};

/// A change of the command by Du that comes d late changes the speed by -d Du / m for good. What short shots
/// in which the axis slides one way leave beside a free begin has, on the average, the covariance
///
///     s_q^2 I + s_d^2 sum_j (Du_j / m)^2 h_j h_j' + s_F^2 (T / m)^2 sum_j h_j h_j'
///
/// with h_j the way after a unit of speed in tick j, s_q the noise of a reading and s_F a force that nobody
/// commanded. The three variances are those of the restricted likelihood [PattersonThompson1971], by means
/// over two ticks; noise of a reading is rough and a jitter's way is smooth, and where the excitation's fast
/// square wave is lesser (make_excitation()) a force that nobody commanded goes on. Interval: by the scores
/// of each part of a period, which may repeat itself in the next. Nothing if fewer than 24 shots slide.
[[nodiscard]] std::optional<DelayJitter> delay_jitter(const AxisData& data,
                                                      std::span<const Stretch> stretches,
                                                      const PlacedModel& model);

}  // namespace kerf::identification

#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <kerf/drivers/gaussian.h>

namespace kerf::drivers {

/// The force of a trembling hand: white noise through a resonance at 10 Hz, 4 Hz wide, a value each
/// millisecond that holds until the next. Physiological tremor lies between 8 and 12 Hz.
///
///     f(n) = 2 r cos(w) f(n-1) - r^2 f(n-2) + g e(n),   g so that the variance of f is that asked for
class Tremor {
 public:
  static constexpr double period_s = 1e-3;

  Tremor(double rms_n, std::uint64_t seed) noexcept
      : noise_(seed),
        gain_(rms_n *
              std::sqrt((1.0 - r2) * (1.0 - 2.0 * r2 * std::cos(2.0 * angle) + r2 * r2) / (1.0 + r2))) {}

  double next() noexcept {
    const double now = 2.0 * radius * std::cos(angle) * last_ - r2 * before_ + gain_ * noise_();
    before_ = last_;
    last_ = now;
    return now;
  }

 private:
  static constexpr double angle = 2.0 * std::numbers::pi * 10.0 * period_s;
  static constexpr double radius = 0.987512256523656;  ///< exp(-pi 4 Hz 1 ms)
  static constexpr double r2 = radius * radius;

  Gaussian noise_;
  double gain_;
  double last_ = 0.0;
  double before_ = 0.0;
};

}  // namespace kerf::drivers

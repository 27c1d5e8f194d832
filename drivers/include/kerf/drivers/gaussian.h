#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace kerf::drivers {

/// Normally distributed numbers of mean 0 and deviation 1, the same on every standard library: Box and
/// Muller's transform of std::mt19937_64, whose sequence the standard fixes (that of std::normal_distribution
/// it does not).
class Gaussian {
 public:
  explicit Gaussian(std::uint64_t seed) : engine_(seed) {}

  double operator()() noexcept {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  /// In (0, 1], from the upper 53 bits.
  double uniform() noexcept { return (static_cast<double>(engine_() >> 11U) + 1.0) * 0x1p-53; }

  std::mt19937_64 engine_;
};

}  // namespace kerf::drivers

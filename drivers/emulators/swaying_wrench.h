#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace kerf::emulators {

/// What acts on the transducer of an emulated sensor, known at any time:
///
///     component i = A_i sin(2 pi f_i t),   f = 0.7, 1.1, 1.3, 1.7, 1.9, 2.3 Hz
///
/// forces with the amplitude `force_n`, torques with `torque_n_m`.
struct SwayingWrench {
  double force_n = 8.0;
  double torque_n_m = 0.4;

  [[nodiscard]] std::array<double, 6> at(double time_s) const noexcept {
    constexpr std::array frequencies_hz{0.7, 1.1, 1.3, 1.7, 1.9, 2.3};
    std::array<double, 6> wrench{};
    for (std::size_t i = 0; i < wrench.size(); ++i) {
      const double phase = 2.0 * std::numbers::pi * frequencies_hz[i] * time_s;
      wrench[i] = (i < 3 ? force_n : torque_n_m) * std::sin(phase);
    }
    return wrench;
  }
};

}  // namespace kerf::emulators

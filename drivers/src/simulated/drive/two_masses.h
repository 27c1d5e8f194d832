#pragma once

#include <array>
#include <cstddef>

#include "kerf/mechanisms/exponential.h"
#include "kerf/mechanisms/held_mass.h"

namespace kerf::drivers {

/// A motor that drives a handle through something that yields: a spring and a damper, or play, or both.
///
///     m1 x1'' = F1 - b x1' - f_c sign(x1') + C,   m2 x2'' = F2 - B x2' - K x2 - C
///     C = k (d - g/2 sign(d)) + c d'  where |d| > g/2, else 0,   d = x2 - x1
///
/// Stepped by `step_s`: each part of it where nothing changes its sign is a matrix exponential; a change
/// (contact, rest) takes effect at the end of its step. `grounded` is a hand's spring and damper on x2.
struct TwoMasses {
  mechanisms::HeldMass motor;     ///< mass, damping and friction; no spring
  mechanisms::HeldMass grounded;  ///< mass, damping and spring of handle and hand; no friction
  double stiffness_n_per_m = 0.0;
  double damping_n_s_per_m = 0.0;
  double gap_m = 0.0;

  struct State {
    mechanisms::AxisMotion motor;
    mechanisms::AxisMotion handle;
  };
  static constexpr double step_s = 10e-6;

  /// Makes the matrices of step_s.
  void prepare() noexcept;
  /// At most one step on, under constant forces. `place_m` is where the hand's spring rests.
  void step(State& state, double motor_n, double handle_n, double place_m, double time_s) const noexcept;
  /// C, on the motor.
  [[nodiscard]] double coupling_n(const State& state) const noexcept;

 private:
  using Matrix = mechanisms::SquareMatrix<6>;
  [[nodiscard]] Matrix over(bool touching, double time_s) const noexcept;
  [[nodiscard]] bool touches(const State& state) const noexcept;

  std::array<Matrix, 2> steps_{};  ///< apart, touching
};

}  // namespace kerf::drivers

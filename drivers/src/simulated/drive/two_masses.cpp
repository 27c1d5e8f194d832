#include "simulated/drive/two_masses.h"

#include <cmath>

namespace kerf::drivers {

TwoMasses::Matrix TwoMasses::over(bool touching, double time_s) const noexcept {
  const double k = touching ? stiffness_n_per_m : 0.0;
  const double c = touching ? damping_n_s_per_m : 0.0;
  const double m1 = motor.mass_kg;
  const double m2 = grounded.mass_kg;
  // x1, v1, x2, v2, F1, F2
  return mechanisms::exponential<6>(
      {{{0.0, 1.0, 0.0, 0.0, 0.0, 0.0},
        {-k / m1, -(c + motor.damping_n_s_per_m) / m1, k / m1, c / m1, 1.0 / m1, 0.0},
        {0.0, 0.0, 0.0, 1.0, 0.0, 0.0},
        {k / m2, c / m2, -(k + grounded.stiffness_n_per_m) / m2, -(c + grounded.damping_n_s_per_m) / m2, 0.0,
         1.0 / m2},
        {0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
        {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}}},
      time_s);
}

void TwoMasses::prepare() noexcept { steps_ = {over(false, step_s), over(true, step_s)}; }

bool TwoMasses::touches(const State& state) const noexcept {
  return gap_m == 0.0 || std::abs(state.handle.position_m - state.motor.position_m) > 0.5 * gap_m;
}

double TwoMasses::coupling_n(const State& state) const noexcept {
  if (!touches(state)) return 0.0;
  const double apart_m = state.handle.position_m - state.motor.position_m;
  return stiffness_n_per_m * (apart_m - std::copysign(0.5 * gap_m, apart_m)) +
         damping_n_s_per_m * (state.handle.speed_m_s - state.motor.speed_m_s);
}

void TwoMasses::step(State& state, double motor_n, double handle_n, double place_m,
                     double time_s) const noexcept {
  const bool touching = touches(state);
  const double coupling = coupling_n(state);
  const double sign = motor.direction(state.motor, motor_n + coupling);
  const double offset_n =
      touching
          ? stiffness_n_per_m * std::copysign(0.5 * gap_m, state.handle.position_m - state.motor.position_m)
          : 0.0;
  // Friction holds the motor: nothing but it balances the force.
  const double first_n = (sign == 0.0 ? -coupling : motor_n - sign * motor.friction_n(sign)) - offset_n;
  // Of the hand's spring at its place, the constant part is a force.
  const double second_n = handle_n + grounded.stiffness_n_per_m * place_m + offset_n;
  const std::array<double, 6> before{state.motor.position_m,
                                     state.motor.speed_m_s,
                                     state.handle.position_m,
                                     state.handle.speed_m_s,
                                     first_n,
                                     second_n};
  const bool whole = std::abs(time_s - step_s) < 1e-12;
  const Matrix part = whole ? Matrix{} : over(touching, time_s);
  const Matrix& m = whole ? steps_[touching ? 1 : 0] : part;
  std::array<double, 4> after{};
  for (std::size_t i = 0; i < after.size(); ++i) {
    for (std::size_t j = 0; j < before.size(); ++j) after[i] += m[i][j] * before[j];
  }
  const double motor_m = state.motor.position_m;
  state = {.motor = {.position_m = after[0], .speed_m_s = after[1]},
           .handle = {.position_m = after[2], .speed_m_s = after[3]}};
  if (sign == 0.0) {
    state.motor = {.position_m = motor_m, .speed_m_s = 0.0};
  } else if (!motor.is_linear() && state.motor.speed_m_s * sign < 0.0) {
    state.motor.speed_m_s = 0.0;
  }
}

}  // namespace kerf::drivers

#pragma once

#include <algorithm>
#include <cmath>

namespace kerf::drivers {

/// A handle that a hand moves, in metres of handle travel:
///
///     m dv/dt = K (s_d - s) + B (v_d - v) - b v - f_c sign(v) + F
///
/// with the mass m of device and hand, the hand's stiffness K and damping B about its equilibrium s_d, the
/// device's viscous friction b and Coulomb friction f_c, and all other forces F. Springs and dampers are
/// stepped implicitly, and Coulomb friction takes away at most the speed there is, so that the mechanism
/// itself never makes energy.
struct SimulatedAxis {
  double mass_kg = 0.16;
  double viscous_n_s_per_m = 0.2;
  double coulomb_n = 0.1;
  double hand_stiffness_n_per_m = 0.0;
  double hand_damping_n_s_per_m = 0.0;
  double lower_m = -1.0;  ///< hard stops
  double upper_m = 1.0;

  struct State {
    double travel_m = 0.0;
    double speed_m_s = 0.0;
  };
  struct Drive {
    double equilibrium_m = 0.0;
    double equilibrium_speed_m_s = 0.0;
    double force_n = 0.0;
  };

  void step(State& state, const Drive& drive, double dt) const noexcept {
    const double pull = hand_stiffness_n_per_m * (drive.equilibrium_m - state.travel_m) +
                        hand_damping_n_s_per_m * drive.equilibrium_speed_m_s + drive.force_n;
    const double inertia =
        mass_kg + dt * (hand_damping_n_s_per_m + viscous_n_s_per_m) + dt * dt * hand_stiffness_n_per_m;
    double speed = (mass_kg * state.speed_m_s + dt * pull) / inertia;
    speed = std::copysign(std::max(0.0, std::abs(speed) - dt * coulomb_n / inertia), speed);
    const double travel = state.travel_m + dt * speed;
    state.travel_m = std::clamp(travel, lower_m, upper_m);
    state.speed_m_s = travel == state.travel_m ? speed : 0.0;
  }
};

}  // namespace kerf::drivers

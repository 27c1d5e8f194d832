#pragma once

#include <cmath>
#include <complex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Standard linear solid ("Kelvin model"): a spring beside a spring and a dashpot in series.
///
///     F = k1 x + f,   df/dt = k2 v - f / tau,   tau = b / k2
///
/// Exact for penetration that is linear in time within a tick (first-order hold), with a = exp(-T/tau):
///
///     f[n+1] = a f[n] + (b/T) (1 - a) (x[n+1] - x[n])
///
/// so the result does not depend on the period and never goes unstable. The option `integrator = "euler"`
/// steps forward Euler instead, which diverges for T > 2 tau: the bench shows where. Contact is unilateral:
/// the force felt is never below zero while the arm keeps relaxing. The first tick takes the arm as relaxed.
///
/// Source: 002, fig. 2 and section 2.1; differs from the paper in that b, printed without a unit, is N·s/m.
template <typename T>
struct Kelvin {
  static constexpr std::string_view name = "kelvin";
  static constexpr std::string_view equation = "F = k1 x + f, df/dt = k2 v - f k2 / b";

  T parallel_stiffness{};  ///< k1 [N/m], > 0
  T series_stiffness{};    ///< k2 [N/m], > 0
  T damping{};             ///< b [N·s/m], > 0
  bool euler = false;

  struct State {
    T arm_force{0.0};
    T decay{1.0};  ///< a of `period_s`
    double penetration = 0.0;
    double period_s = 0.0;
    bool started = false;
  };

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {{"parallel_stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic,
             "k1, spring beside the arm"},
            {"series_stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic, "k2, spring of the arm"},
            {"damping", Quantity::damping, 1e-9, 1e9, Scale::logarithmic, "b, dashpot of the arm"}};
  }
  static std::vector<OptionInfo> options() {
    return {{"integrator", std::string("exact"), "exact (first-order hold) or euler (forward Euler)"}};
  }
  static Kelvin make(std::span<const T> values, const Options& given) {
    const std::string integrator =
        OptionReader(name, options(), given).choice("integrator", {"exact", "euler"});
    return {values[0], values[1], values[2], integrator == "euler"};
  }

  /// Relaxation time tau = b / k2 [s].
  [[nodiscard]] T relaxation_time() const { return damping / series_stiffness; }

  /// Force over penetration for a sinusoidal motion, k1 + k2 i w tau / (1 + i w tau) [N/m], at w [rad/s].
  [[nodiscard]] std::complex<double> dynamic_stiffness(double frequency_rad_s) const {
    const std::complex<double> lag(0.0, frequency_rad_s * relaxation_time());
    return parallel_stiffness + series_stiffness * lag / (1.0 + lag);
  }

  /// Energy held by the two springs [J], for a penetration in metres.
  [[nodiscard]] T stored_energy(const State& state) const {
    return 0.5 * parallel_stiffness * state.penetration * state.penetration +
           0.5 * state.arm_force * state.arm_force / series_stiffness;
  }

  /// Force of a contact: none before it, and never pulling.
  T step(State& state, const Motion& motion, double period_s) const noexcept {
    const T force = bilateral_step(state, motion.penetration > 0.0 ? motion.penetration : 0.0, period_s);
    return force < T(0.0) ? T(0.0) : force;
  }

  /// Force of the element itself, which pulls as it pushes, at a displacement x [m].
  T bilateral_step(State& state, double x, double period_s) const noexcept {
    using std::expm1;
    if (!state.started) {
      state.started = true;
      state.penetration = x;
    }
    if (period_s != state.period_s) {
      state.period_s = period_s;
      state.decay =
          euler ? T(1.0 - period_s / relaxation_time()) : T(1.0 + expm1(-period_s / relaxation_time()));
    }
    const double travel = x - state.penetration;
    const T gain = euler ? series_stiffness : T(damping / period_s * (1.0 - state.decay));
    state.arm_force = state.decay * state.arm_force + gain * travel;
    state.penetration = x;
    return parallel_stiffness * x + state.arm_force;
  }
};

}  // namespace kerf::models

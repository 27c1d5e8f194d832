#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/choice.h>
#include <kerf/models/contact_energy.h>
#include <kerf/models/integrator.h>
#include <kerf/models/law_facts.h>
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
/// so the result does not depend on the period and never goes unstable. The option `integrator` has two other
/// steps (integrator.h), so that the bench can show what they cost: "semi_implicit", stable but of first
/// order, and "euler", which diverges for T > 2 tau. Contact is unilateral: the force felt is never below
/// zero while the arm keeps relaxing; with the option `bilateral` it is that of the element, which pulls too.
/// The first tick takes the arm as relaxed. With `precision = "float"` the forces are single, and only the
/// travel of a tick is still a difference of doubles.
///
/// Source: [FuzzyKelvin], fig. 2 and section 2.1; differs from the paper in that b, printed without a unit,
/// is N·s/m.
template <typename T>
struct Kelvin {
  static constexpr std::string_view name = "kelvin";
  static constexpr std::string_view equation = "F = k1 x + f, df/dt = k2 v - f k2 / b";
  static constexpr LawFacts facts{
      .search = Search::descent,
      .scan = {.over = Scan::relaxation, .parameter = "damping", .spring = "series_stiffness"},
      .arm = {"series_stiffness", "damping"},
      .fineness = Fineness::integrators,
      .in_float = true,
      .usual = 1,
      .charted = true,
      .variants = {{.effects = {Effect::relaxation, Effect::rate}}}};

  T parallel_stiffness{};  ///< k1 [N/m], > 0
  T series_stiffness{};    ///< k2 [N/m], > 0
  T damping{};             ///< b [N·s/m], > 0
  Integrator integrator = Integrator::exact;
  bool bilateral = false;  ///< pulls as it pushes

  struct State {
    T arm_force{0};
    ArmTick<T> tick;  ///< of `period_s`
    Signal<T> penetration = 0.0;
    Signal<T> period_s = 0.0;
    Signal<T> shortest_s = std::numeric_limits<double>::infinity();  ///< of the periods so far
    bool started = false;
    T reachable{-1};  ///< of the springs' energy (contact_step()) [J]; below zero: all of it

    /// What the force goes on from, by name.
    template <typename Visit>
    void each(Visit&& visit) {
      visit("arm_force", arm_force);
      visit("loss", tick.loss);
      visit("gain", tick.gain);
      visit("penetration", penetration);
      visit("period_s", period_s);
      visit("shortest_s", shortest_s);
      visit("started", started);
    }

    /// What is behind a rupture no longer strains the element: it begins anew, of what the rupture leaves.
    void rupture() noexcept {
      arm_force = T(0);
      penetration = 0.0;
      reachable = T(-1);
    }
  };

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {{"parallel_stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic,
             "k1, spring beside the arm"},
            {"series_stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic, "k2, spring of the arm"},
            {"damping", Quantity::damping, 1e-9, 1e9, Scale::logarithmic, "b, dashpot of the arm"}};
  }
  static std::vector<OptionInfo> options() {
    return {bilateral_option(), integrator_option(), precision_option()};
  }
  static Kelvin make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    return {values[0], values[1], values[2], integrator_of(reader), reader.flag("bilateral")};
  }

  /// Relaxation time tau = b / k2 [s].
  [[nodiscard]] T relaxation_time() const { return damping / series_stiffness; }

  /// Force over penetration for a sinusoidal motion, k1 + k2 i w tau / (1 + i w tau) [N/m], at w [rad/s].
  [[nodiscard]] std::complex<double> dynamic_stiffness(double frequency_rad_s) const {
    const std::complex<double> lag(0.0, frequency_rad_s * relaxation_time());
    return parallel_stiffness + series_stiffness * lag / (1.0 + lag);
  }

  /// Energy held by the two springs [J], for a penetration in metres.
  [[nodiscard]] T spring_energy(const State& state) const noexcept {
    const Input<T> half(0.5);
    const auto x = static_cast<Input<T>>(state.penetration);
    return half * parallel_stiffness * x * x + half * state.arm_force * state.arm_force / series_stiffness;
  }
  /// Energy that a contact gives back at most (contact_step()) [J], for a penetration in metres.
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return state.reachable < T(0) ? spring_energy(state) : state.reachable;
  }
  /// Force of the element where it was left [N].
  [[nodiscard]] T held_force(const State& state) const noexcept {
    return parallel_stiffness * static_cast<Input<T>>(state.penetration) + state.arm_force;
  }

  /// Which it does not fall below on its way out to x, the arm relaxed or not [N].
  [[nodiscard]] T least_force(const State& state, double x, double) const noexcept {
    return parallel_stiffness * static_cast<Input<T>>(x) + std::min(state.arm_force, T(0)) +
           series_stiffness * static_cast<Input<T>>(x - state.penetration);
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T> period_s) const noexcept {
    return element_step(*this, state, motion.penetration, period_s);
  }

  /// Force of the element itself, which pulls as it pushes, at a displacement x [m].
  T bilateral_step(State& state, Signal<T> x, Signal<T> period_s) const noexcept {
    if (!state.started) {
      state.started = true;
      state.penetration = x;
    }
    if (period_s != state.period_s) {
      state.period_s = period_s;
      state.shortest_s = lesser(state.shortest_s, period_s);
      state.tick =
          ArmTick<T>::of(integrator, series_stiffness, relaxation_time(), period_s, state.shortest_s);
    }
    const auto travel = static_cast<Input<T>>(x - state.penetration);
    state.arm_force = state.arm_force + (state.tick.gain * travel - state.tick.loss * state.arm_force);
    state.penetration = x;
    return parallel_stiffness * static_cast<Input<T>>(x) + state.arm_force;
  }
};

}  // namespace kerf::models

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <kerf/models/choice.h>
#include <kerf/models/contact_energy.h>
#include <kerf/models/integrator.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Generalised Maxwell model (a Prony series): a spring beside n arms of a spring and a dashpot in series.
///
///     F = k0 x + f_1 + ... + f_n,   df_i/dt = k_i v - f_i / tau_i
///
/// k0 [N/m], k_i [N/m] and the relaxation times tau_i [s] of the arms; the dashpots are b_i = k_i tau_i. The
/// times are the parameters and not the dashpots, since it is times that a relaxation shows, and since the
/// force is linear in the stiffnesses once they are given. Their order means nothing. With one arm it is the
/// Kelvin law; a fluid has k0 at its lower bound.
///
/// Exact for penetration that is linear in time within a tick (first-order hold), with a_i = exp(-T/tau_i):
///
///     f_i[n+1] = a_i f_i[n] + (k_i tau_i / T) (1 - a_i) (x[n+1] - x[n])
///
/// `integrator` and `precision` as in Kelvin; forward Euler diverges where an arm has T > 2 tau_i.
///
/// Contact is unilateral as in Kelvin, unless `bilateral`: no force below zero, while the arms keep relaxing,
/// and the first tick takes them as relaxed. Exact, it is passive at every period: springs and dashpots, all
/// positive.
///
/// Source: Maxwell's arms in parallel as in [Ferry1980], chapter 1; [FuzzyKelvin]
/// uses one of them.
template <typename T>
struct Maxwell {
  static constexpr std::string_view name = "maxwell";
  static constexpr std::string_view equation = "F = k0 x + sum f_i, df_i/dt = k_i v - f_i / tau_i";
  static constexpr LawFacts facts{
      .search = Search::descent,
      .searched_at_once = 14,
      .scan = {.over = Scan::prony},
      .size = {.option = "arms", .unit = "arm", .first = 1, .last = 4, .grows = true},
      .arm = {"stiffness[", "relaxation_time["},
      .fineness = Fineness::integrators,
      .in_float = true,
      .usual = 5,
      .charted = true,
      .variants = {{.effects = {Effect::relaxation, Effect::rate}, .sizes_from = 2}},  // of one: kelvin
      .rank = 1};
  static constexpr std::size_t max_arms = 6;

  std::size_t arms = 1;
  T parallel_stiffness{};                     ///< k0 [N/m], > 0
  std::array<T, max_arms> stiffness{};        ///< k_i [N/m], > 0
  std::array<T, max_arms> relaxation_time{};  ///< tau_i [s], > 0
  Integrator integrator = Integrator::exact;
  bool bilateral = false;  ///< pulls as it pushes

  struct State {
    std::array<T, max_arms> arm_force{};
    std::array<ArmTick<T>, max_arms> tick{};  ///< of `period_s`
    Signal<T> penetration = 0.0;
    Signal<T> period_s = 0.0;
    Signal<T> shortest_s = std::numeric_limits<double>::infinity();  ///< of the periods so far
    bool started = false;
    T reachable{-1};  ///< of the springs' energy (contact_step()) [J]; below zero: all of it

    /// What the force goes on from, by name.
    template <typename Visit>
    void each(Visit&& visit) {
      visit("arm_force", arm_force);
      for (std::size_t i = 0; i < max_arms; ++i) {
        visit("loss_" + std::to_string(i), tick[i].loss);
        visit("gain_" + std::to_string(i), tick[i].gain);
      }
      visit("penetration", penetration);
      visit("period_s", period_s);
      visit("shortest_s", shortest_s);
      visit("started", started);
    }
  };

  static std::vector<OptionInfo> options() {
    return {{"arms", 2.0, "number of arms, each with a relaxation time of its own, 1 to 6"},
            bilateral_option(),
            integrator_option(),
            precision_option()};
  }
  static std::vector<ParameterInfo> parameters(const Options& given) {
    const std::size_t count = arm_count(given);
    std::vector<ParameterInfo> all{{"parallel_stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic,
                                    "k0, spring beside the arms"}};
    const auto add = [&](const char* what, Quantity quantity, double bound, const char* meaning) {
      for (std::size_t i = 0; i < count; ++i) {
        all.push_back({std::string(what) + "[" + std::to_string(i) + "]", quantity, 1.0 / bound, bound,
                       Scale::logarithmic, meaning});
      }
    };
    add("stiffness", Quantity::stiffness, 1e9, "k_i, spring of an arm");
    add("relaxation_time", Quantity::time, 1e6, "tau_i, in which the force of an arm falls to 1/e");
    return all;
  }
  static Maxwell make(std::span<const T> values, const Options& given) {
    Maxwell law;
    law.arms = arm_count(given);
    const OptionReader reader(name, options(), given);
    law.integrator = integrator_of(reader);
    law.bilateral = reader.flag("bilateral");
    law.parallel_stiffness = values[0];
    for (std::size_t i = 0; i < law.arms; ++i) {
      law.stiffness[i] = values[1 + i];
      law.relaxation_time[i] = values[1 + law.arms + i];
    }
    return law;
  }

  /// Force over penetration for a sinusoidal motion, k0 + sum k_i i w tau_i / (1 + i w tau_i) [N/m], at w
  /// [rad/s].
  [[nodiscard]] std::complex<double> dynamic_stiffness(
      double frequency_rad_s) const requires std::is_floating_point_v<T> {
    std::complex<double> sum = parallel_stiffness;
    for (std::size_t i = 0; i < arms; ++i) {
      const std::complex<double> lag(0.0, frequency_rad_s * relaxation_time[i]);
      sum += stiffness[i] * lag / (1.0 + lag);
    }
    return sum;
  }

  /// Energy held by the springs [J], for a penetration in metres.
  [[nodiscard]] T spring_energy(const State& state) const noexcept {
    const Input<T> half(0.5);
    const auto x = static_cast<Input<T>>(state.penetration);
    T energy = half * parallel_stiffness * x * x;
    for (std::size_t i = 0; i < arms; ++i) {
      energy = energy + half * state.arm_force[i] * state.arm_force[i] / stiffness[i];
    }
    return energy;
  }
  /// Energy that a contact gives back at most (contact_step()) [J], for a penetration in metres.
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return state.reachable < T(0) ? spring_energy(state) : state.reachable;
  }
  /// Force of the element where it was left [N].
  [[nodiscard]] T held_force(const State& state) const noexcept {
    T force = parallel_stiffness * static_cast<Input<T>>(state.penetration);
    for (std::size_t i = 0; i < arms; ++i) force = force + state.arm_force[i];
    return force;
  }

  /// Which it does not fall below on its way out to x, the arms relaxed or not [N].
  [[nodiscard]] T least_force(const State& state, double x, double) const noexcept {
    const auto travel = static_cast<Input<T>>(x - state.penetration);
    T force = parallel_stiffness * static_cast<Input<T>>(x);
    for (std::size_t i = 0; i < arms; ++i) {
      force = force + std::min(state.arm_force[i], T(0)) + stiffness[i] * travel;
    }
    return force;
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
    if (period_s != state.period_s) hold(state, period_s);
    const auto travel = static_cast<Input<T>>(x - state.penetration);
    state.penetration = x;
    T force = parallel_stiffness * static_cast<Input<T>>(x);
    for (std::size_t i = 0; i < arms; ++i) {
      T& arm = state.arm_force[i];
      arm = arm + (state.tick[i].gain * travel - state.tick[i].loss * arm);
      let_go(arm, negligible_n);
      force = force + arm;
    }
    return force;
  }

 private:
  // What a long hold leaves would soon be denormal, and slow to reckon with.
  static constexpr Input<T> negligible_n = static_cast<Input<T>>(Scalars<T>::single ? 1e-30 : 1e-100);

  static std::size_t arm_count(const Options& given) {
    return OptionReader(name, options(), given).count("arms", 1, max_arms);
  }
  void hold(State& state, Signal<T> period_s) const noexcept {
    state.period_s = period_s;
    state.shortest_s = lesser(state.shortest_s, period_s);
    for (std::size_t i = 0; i < arms; ++i) {
      state.tick[i] =
          ArmTick<T>::of(integrator, stiffness[i], relaxation_time[i], period_s, state.shortest_s);
    }
  }
};

}  // namespace kerf::models

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <kerf/models/choice.h>
#include <kerf/models/contact_energy.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Fractional Kelvin-Voigt model: a spring beside a springpot, whose force relaxes as a power of time.
///
///     F = k x + c T0^alpha d^alpha x / dt^alpha,   0 < alpha < 1 (derivative of Caputo)
///
/// k [N/m], c [N/m], alpha [1]. The reference time T0 [s] is a setting and only scales c: a springpot that is
/// pushed in at once by x holds c x (t/T0)^-alpha / Gamma(1 - alpha) after the time t. With T0 = 1 s the
/// number c is the coefficient in N·s^alpha/m; with T0 within the times recorded, c and alpha are told apart
/// best. Without the option `spring` the springpot stands alone. alpha towards 0 is a spring, towards 1 a
/// dashpot.
///
/// No history is kept. The kernel is a sum of decays with fixed rates s_j in geometric steps exp(h),
///
///     t^-alpha / Gamma(1 - alpha) = (sin(pi alpha) / pi) integral s^(alpha-1) exp(-s t) ds
///                                 ~ (sin(pi alpha) / pi) h sum s_j^alpha exp(-s_j t)
///
/// (the trapezoid in log s), each held exactly for penetration that is linear within a tick. What lies below
/// the slowest rate is a spring, what lies above the fastest a dashpot; both sums are geometric series. For
/// every alpha allowed the kernel and the force of a ramp are right to 3e-5 from 20 us to an hour, the
/// dynamic stiffness to 3e-5 from 1e-3 to 1e3 rad/s and to 4e-4 at 1e4 rad/s, whatever the period. A tick
/// with another period than the last one computes its decays anew.
///
/// Contact is unilateral as in Kelvin: no force below zero, while the element keeps relaxing, and the first
/// tick takes it as relaxed. Passive at every period: springs and dashpots, all positive.
///
/// Source: Scott Blair's element with the derivative of Caputo [Caputo1967]; the quadrature is that of
/// [BeylkinMonzon2010], for powers, its ends closed as above.
template <typename T>
struct Springpot {
  static constexpr std::string_view name = "springpot";
  static constexpr std::string_view equation = "F = k x + c T0^alpha d^alpha x / dt^alpha";
  static constexpr LawFacts facts{.search = Search::descent,
                                  .scan = {.over = Scan::values,
                                           .parameter = "order",
                                           .values = {0.03, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95}},
                                  .charted = true,
                                  .variants = {{.suffix = "-alone",
                                                .options = {"spring=false"},
                                                .effects = {Effect::relaxation, Effect::rate}},
                                               {.effects = {Effect::relaxation, Effect::rate}}},
                                  .rank = -1};
  static constexpr std::size_t decays = 40;
  static constexpr double log_spacing = 0.75;  ///< h
  static constexpr double fastest_rate = 1e6;  ///< [1/s]

  T stiffness{};                ///< k [N/m], > 0, or 0 without the spring
  T fractional_stiffness{};     ///< c [N/m], > 0
  T order{};                    ///< alpha [1]
  double reference_time = 1.0;  ///< T0 [s]
  bool bilateral = false;       ///< pulls as it pushes

  /// The kernel's weights, which follow from c, alpha and T0.
  std::array<T, decays> weight{};  ///< [N/m] of each decay
  T slow{};                        ///< [N/m], of what is slower than all of them
  T fast{};                        ///< [N·s/m], of what is faster

  struct State {
    std::array<Signal<T>, decays> displacement{};  ///< of each decay's spring
    /// What a tick of one period does. Two are kept: stamps of whole milliseconds go from one to another.
    struct Tick {
      Signal<T> period_s = 0.0;
      std::array<Signal<T>, decays> decay{};
      std::array<Signal<T>, decays> gain{};  ///< displacement per travel
    };
    std::array<Tick, 2> tick{};
    std::size_t current = 0;
    Signal<T> beginning = 0.0;  ///< penetration of the first tick
    Signal<T> penetration = 0.0;
    bool started = false;
    T reachable{-1.0};  ///< of the springs' energy (contact_step()) [J]; below zero: all of it

    /// What the force goes on from, by name.
    template <typename Visit>
    void each(Visit&& visit) {
      visit("displacement", displacement);
      for (std::size_t i = 0; i < tick.size(); ++i) {
        visit("period_" + std::to_string(i), tick[i].period_s);
        visit("decay_" + std::to_string(i), tick[i].decay);
        visit("gain_" + std::to_string(i), tick[i].gain);
      }
      visit("current", current);
      visit("beginning", beginning);
      visit("penetration", penetration);
      visit("started", started);
    }
  };

  static std::vector<OptionInfo> options() {
    return {bilateral_option(),
            {"spring", true, "a spring beside the springpot"},
            {"reference_time", 1.0, "T0, time at which the force is judged by c [s]"}};
  }
  static std::vector<ParameterInfo> parameters(const Options& given) {
    std::vector<ParameterInfo> all;
    if (OptionReader(name, options(), given).flag("spring")) {
      all.push_back({"stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic,
                     "k, spring beside the springpot"});
    }
    all.push_back({"fractional_stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic,
                   "c, of the springpot at the reference time"});
    all.push_back(
        {"order", Quantity::ratio, 0.01, 0.99, Scale::linear, "alpha, from 0 (a spring) to 1 (a dashpot)"});
    return all;
  }
  static Springpot make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    const std::size_t first = reader.flag("spring") ? 1 : 0;
    Springpot law;
    if (first == 1) law.stiffness = values[0];
    law.fractional_stiffness = values[first];
    law.order = values[first + 1];
    law.reference_time = reader.number("reference_time", 1e-9, 1e9);
    law.bilateral = reader.flag("bilateral");
    law.weigh();
    return law;
  }

  /// Force over penetration for a sinusoidal motion, k + c (i w T0)^alpha [N/m], at w [rad/s].
  [[nodiscard]] std::complex<double> dynamic_stiffness(
      double frequency_rad_s) const requires std::is_floating_point_v<T> {
    return stiffness + fractional_stiffness * std::polar(std::pow(frequency_rad_s * reference_time, order),
                                                         0.5 * std::numbers::pi * order);
  }

  /// Energy held by the springs [J], for a penetration in metres.
  [[nodiscard]] T spring_energy(const State& state) const noexcept {
    const double moved = state.penetration - state.beginning;
    T twice = stiffness * (state.penetration * state.penetration) + slow * (moved * moved);
    for (std::size_t j = 0; j < decays; ++j) {
      twice = twice + weight[j] * (state.displacement[j] * state.displacement[j]);
    }
    return 0.5 * twice;
  }
  /// Energy that a contact gives back at most (contact_step()) [J], for a penetration in metres.
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return state.reachable < T(0) ? spring_energy(state) : state.reachable;
  }
  /// Force of the element where it was left, at rest [N].
  [[nodiscard]] T held_force(const State& state) const noexcept {
    return stiffness * state.penetration + slow * (state.penetration - state.beginning) +
           decaying_force(state);
  }

  /// Which it does not fall below on its way out to x, the decays relaxed or not [N].
  [[nodiscard]] T least_force(const State& state, double x, double period_s) const noexcept {
    const double travel = x - state.penetration;
    std::array<T, lanes> sum{};
    for (std::size_t j = 0; j < decays; j += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        sum[lane] = sum[lane] + weight[j + lane] * (std::min(state.displacement[j + lane], 0.0) + travel);
      }
    }
    return stiffness * x + slow * (x - state.beginning) + fast * (travel / period_s) +
           ((sum[0] + sum[1]) + (sum[2] + sum[3]));
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T> period_s) const noexcept {
    return element_step(*this, state, motion.penetration, period_s);
  }

  /// Force of the element itself, which pulls as it pushes, at a displacement x [m].
  T bilateral_step(State& state, Signal<T> x, Signal<T> period_s) const noexcept {
    using std::abs;
    if (!state.started) {
      state.started = true;
      state.beginning = x;
      state.penetration = x;
    }
    if (period_s != state.tick[state.current].period_s) hold(state, period_s);
    const typename State::Tick& tick = state.tick[state.current];
    const Signal<T> travel = x - state.penetration;
    state.penetration = x;
    for (std::size_t j = 0; j < decays; ++j) {
      const Signal<T> next = tick.decay[j] * state.displacement[j] + tick.gain[j] * travel;
      // What a long hold leaves would soon be denormal, and slow to reckon with.
      state.displacement[j] = chosen(abs(next) < 1e-100, Signal<T>(0.0), next);
    }
    return stiffness * x + slow * (x - state.beginning) + fast * (travel / period_s) + decaying_force(state);
  }

 private:
  static constexpr std::size_t lanes = 4;  // sums that need not wait for each other

  static double log_rate(std::size_t j) {
    return std::log(fastest_rate) - log_spacing * static_cast<double>(j);
  }
  void weigh() {
    using std::exp;
    using std::expm1;
    using std::sin;
    const T scale = fractional_stiffness * exp(order * std::log(reference_time)) *
                    sin(std::numbers::pi * order) * (log_spacing / std::numbers::pi);
    for (std::size_t j = 0; j < decays; ++j) weight[j] = scale * exp(order * log_rate(j));
    slow = scale * exp(order * log_rate(decays)) / -expm1(-log_spacing * order);
    const T remaining = 1.0 - order;
    fast = scale * exp(-remaining * (log_rate(0) + log_spacing)) / -expm1(-log_spacing * remaining);
  }
  static void hold(State& state, Signal<T> period_s) noexcept {
    using std::exp;
    using std::expm1;
    state.current = 1 - state.current;
    typename State::Tick& tick = state.tick[state.current];
    if (period_s == tick.period_s) return;
    tick.period_s = period_s;
    for (std::size_t j = 0; j < decays; ++j) {
      const Signal<T> relaxation = exp(log_rate(j)) * period_s;
      tick.decay[j] = chosen(relaxation < 200.0, Signal<T>(exp(-relaxation)), Signal<T>(0.0));
      tick.gain[j] = -expm1(-relaxation) / relaxation;
    }
  }
  [[nodiscard]] T decaying_force(const State& state) const noexcept {
    static_assert(decays % lanes == 0);
    std::array<T, lanes> sum{};
    for (std::size_t j = 0; j < decays; j += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        sum[lane] = sum[lane] + weight[j + lane] * state.displacement[j + lane];
      }
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
};

}  // namespace kerf::models

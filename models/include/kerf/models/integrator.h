#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include <kerf/models/choice.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// How a spring and a dashpot in series, df/dt = k v - f / tau, go on over a tick.
enum class Integrator {
  exact,          ///< for penetration that is linear within the tick: any period, no error
  semi_implicit,  ///< backward Euler: stable at any period, first order in T / tau
  euler           ///< forward Euler: first order, and diverges for T > 2 tau, T the shortest tick so far
};

/// The tick of such an arm, f[n+1] = f[n] + gain (x[n+1] - x[n]) - loss f[n].
///
///     exact           loss = 1 - exp(-T/tau),      gain = k (tau/T) loss
///     semi-implicit   loss = (T/tau) / (1 + T/tau), gain = k / (1 + T/tau)
///     euler           loss = T/tau,                 gain = k
///
/// k [N/m], tau [s], T the period [s]. The loss stands alone, and not as a factor 1 - loss, so that slow arms
/// keep their relaxation time in single precision too. What is stable in a loop's ticks stays so over a
/// stall: forward Euler takes a period of n times the shortest one as n steps, in closed form.
template <typename T>
struct ArmTick {
  T loss{0};  ///< share of the force that the dashpot takes [1]
  T gain{0};  ///< force per travel [N/m]

  static ArmTick of(Integrator integrator, const T& stiffness, const T& relaxation_time, Signal<T> period_s,
                    Signal<T> shortest_s) noexcept {
    using std::expm1;
    const T periods = static_cast<Input<T>>(period_s) / relaxation_time;
    const Input<T> one(1);
    switch (integrator) {
      case Integrator::semi_implicit: {
        const T share = one / (one + periods);
        return {periods * share, stiffness * share};
      }
      case Integrator::euler: {
        const auto steps = count_of(period_s / shortest_s);
        if (steps < 2) return {periods, stiffness};
        const T loss = loss_of(periods / Input<T>(static_cast<double>(steps)), steps);
        return {loss, stiffness / periods * loss};
      }
      case Integrator::exact:
        break;
    }
    const T loss = -expm1(-periods);
    return {loss, stiffness / periods * loss};
  }

 private:
  /// 1 - (1 - loss)^steps
  static T loss_of(T loss, std::uint64_t steps) noexcept {
    T sum(0);
    for (; steps > 0; steps /= 2) {
      if (steps % 2 == 1) sum = sum + loss - sum * loss;
      loss = loss * (Input<T>(2) - loss);
    }
    return sum;
  }
};

/// The option of a law that has such arms.
[[nodiscard]] inline OptionInfo integrator_option() {
  return {"integrator", std::string("exact"),
          "exact (first-order hold), semi_implicit (backward Euler) or euler (forward Euler)"};
}
[[nodiscard]] inline Integrator integrator_of(const OptionReader& reader) {
  const std::string name = reader.choice("integrator", {"exact", "semi_implicit", "euler"});
  return name == "euler"           ? Integrator::euler
         : name == "semi_implicit" ? Integrator::semi_implicit
                                   : Integrator::exact;
}

}  // namespace kerf::models

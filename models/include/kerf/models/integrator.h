#pragma once

#include <cmath>
#include <string>

#include <kerf/models/parameter.h>

namespace kerf::models {

/// How a spring and a dashpot in series, df/dt = k v - f / tau, go on over a tick.
enum class Integrator {
  exact,          ///< for penetration that is linear within the tick: any period, no error
  semi_implicit,  ///< backward Euler: stable at any period, first order in T / tau
  euler           ///< forward Euler: first order, and diverges for T > 2 tau
};

/// The tick of such an arm, f[n+1] = f[n] + gain (x[n+1] - x[n]) - loss f[n].
///
///     exact           loss = 1 - exp(-T/tau),      gain = k (tau/T) loss
///     semi-implicit   loss = (T/tau) / (1 + T/tau), gain = k / (1 + T/tau)
///     euler           loss = T/tau,                 gain = k
///
/// k [N/m], tau [s], T the period [s]. The loss stands alone, and not as a factor 1 - loss, so that slow arms
/// keep their relaxation time in single precision too.
template <typename T>
struct ArmTick {
  T loss{0};  ///< share of the force that the dashpot takes [1]
  T gain{0};  ///< force per travel [N/m]

  static ArmTick of(Integrator integrator, const T& stiffness, const T& relaxation_time,
                    double period_s) noexcept {
    using std::expm1;
    const T periods = Input<T>(period_s) / relaxation_time;
    const Input<T> one(1);
    switch (integrator) {
      case Integrator::semi_implicit: {
        const T share = one / (one + periods);
        return {periods * share, stiffness * share};
      }
      case Integrator::euler:
        return {periods, stiffness};
      case Integrator::exact:
        break;
    }
    const T loss = -expm1(-periods);
    return {loss, stiffness / periods * loss};
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

#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Spring and viscosity with dry friction, for mechanisms and for loops that do not close with speed.
///
///     F = F0 + k x + b v + Fc z,   dz/dt = (v / xd) (1 - z sgn v)
///
/// F0 [N] and k [N/m] an offset and a spring of either sign, b [N·s/m] viscosity of either sign, Fc >= 0 [N]
/// the Coulomb friction, xd > 0 [m] the presliding displacement, z in [-1, 1] Dahl's state. A reversal takes
/// the friction from Fc to -Fc within a few xd; as xd goes to zero it becomes Fc sgn v. It acts on both sides
/// of zero and pulls as it pushes: nothing here is a contact.
///
/// Exact for a path without a reversal within a tick, at any speed and so at any period:
///
///     z[n+1] = s + (z[n] - s) exp(-|dx| / xd),   s = sgn dx
///
/// Dahl's friction needs no threshold of speed, which Karnopp's has: at a small sampled speed, noisy as it
/// is, a threshold decides at random, and a force that jumps there has no derivative for a fit. Between -X
/// and X a cycle takes 4 Fc (X - xd tanh(X / xd)), at any speed. Passive for b >= 0; a spring and an offset
/// give back what they took, over a closed path, whatever their sign.
///
/// Source: [Dahl1968], with the exponent 1; [Karnopp1985] is the alternative not taken.
template <typename T>
struct Friction {
  static constexpr std::string_view name = "friction";
  static constexpr std::string_view equation = "F = F0 + k x + b v + Fc z, dz/dt = (v / xd) (1 - z sgn v)";
  static constexpr LawFacts facts{.search = Search::descent,
                                  .searched_at_once = 5,
                                  .scan = {.over = Scan::values,
                                           .parameter = "presliding",
                                           .values = {1e-4, 1.0},
                                           .steps = 9,
                                           .unit = ScanUnit::range},
                                  .charted = true,
                                  .variants = {{.effects = {Effect::loop, Effect::rate}}}};

  T offset{};      ///< F0 [N]
  T stiffness{};   ///< k [N/m]
  T viscosity{};   ///< b [N·s/m]
  T coulomb{};     ///< Fc [N], >= 0
  T presliding{};  ///< xd [m], > 0

  struct State {
    T slip{0.0};  ///< z
    Signal<T> penetration = 0.0;
    bool started = false;

    /// What the force goes on from, by name.
    template <typename Visit>
    void each(Visit&& visit) {
      visit("slip", slip);
      visit("penetration", penetration);
      visit("started", started);
    }
  };

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {{"offset", Quantity::force, -1e6, 1e6, Scale::linear, "F0, force at zero and at rest"},
            {"stiffness", Quantity::stiffness, -1e9, 1e9, Scale::linear, "k, force per position"},
            {"viscosity", Quantity::damping, -1e6, 1e6, Scale::linear, "b, force per speed"},
            {"coulomb", Quantity::force, 0.0, 1e6, Scale::linear, "Fc, dry friction"},
            {"presliding", Quantity::position, 1e-9, 1e3, Scale::logarithmic,
             "xd, travel in which the friction builds up"}};
  }
  static std::vector<OptionInfo> options() { return {}; }
  static Friction make(std::span<const T> values, const Options& given) {
    const OptionReader refuses_unknown(name, options(), given);
    return {values[0], values[1], values[2], values[3], values[4]};
  }

  /// Most energy that can be had back from the friction, Fc xd (|z| - log(1 + |z|)) [J].
  [[nodiscard]] T recoverable_energy(const State& state) const noexcept {
    using std::abs;
    using std::log1p;
    const T bent = abs(state.slip);
    return coulomb * presliding * (bent - log1p(bent));
  }
  /// That and the energy of spring and offset, (F0 + k x)^2 / (2 k) [J]. Not a number where spring or offset
  /// have no least energy: k < 0, or an offset without a spring.
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    const T friction = recoverable_energy(state);
    if (stiffness == T(0.0) && offset == T(0.0)) return friction;
    if (!(stiffness > T(0.0))) return T(std::numeric_limits<double>::quiet_NaN());
    const T spring = offset + stiffness * state.penetration;
    return friction + 0.5 * spring * spring / stiffness;
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T>) const noexcept {
    using std::abs;
    using std::exp;
    if (!state.started) {
      state.started = true;
      state.penetration = motion.penetration;
    }
    const Signal<T> travel = motion.penetration - state.penetration;
    state.penetration = motion.penetration;
    if (travel != 0.0) {
      const double sign = travel > 0.0 ? 1.0 : -1.0;
      state.slip = sign + (state.slip - sign) * exp(-abs(travel) / presliding);
    }
    return offset + stiffness * motion.penetration + viscosity * motion.velocity + coulomb * state.slip;
  }
};

}  // namespace kerf::models

#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Spring with Coulomb friction that sticks before it slips.
///
///     F = k x + Fc z,   z[n+1] = min(1, max(-1, z[n] + dx / xd))
///
/// k [N/m] a spring, Fc >= 0 [N] the friction, xd > 0 [m] the travel in which it builds up: an elastic
/// element of the stiffness Fc / xd that gives way at Fc. It acts on both sides of zero and pulls as it
/// pushes: nothing here is a contact. Exact at any period for a path without a reversal within a tick, and at
/// any speed. Between -X and X a cycle takes 4 Fc (X - xd) for X >= xd. Passive: a spring, and a spring that
/// slips.
///
/// Source: Coulomb's friction in Prandtl's element, a spring and a slider in series.
template <typename T>
struct Coulomb {
  static constexpr std::string_view name = "coulomb";
  static constexpr std::string_view equation = "F = k x + Fc z, dz = dx / xd within [-1, 1]";
  static constexpr LawFacts facts{.search = Search::descent,
                                  .scan = {.over = Scan::values,
                                           .parameter = "presliding",
                                           .values = {1e-4, 1.0},
                                           .steps = 9,
                                           .unit = ScanUnit::range},
                                  .variants = {{.effects = {Effect::loop}}}};

  T stiffness{};   ///< k [N/m]
  T coulomb{};     ///< Fc [N], >= 0
  T presliding{};  ///< xd [m], > 0

  struct State {
    T slip{0.0};  ///< z
    double penetration = 0.0;
    bool started = false;
  };

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {{"stiffness", Quantity::stiffness, -1e9, 1e9, Scale::linear, "k, force per position"},
            {"coulomb", Quantity::force, 0.0, 1e6, Scale::linear, "Fc, dry friction"},
            {"presliding", Quantity::position, 1e-9, 1e3, Scale::logarithmic,
             "xd, travel in which the friction builds up"}};
  }
  static std::vector<OptionInfo> options() { return {}; }
  static Coulomb make(std::span<const T> values, const Options& given) {
    const OptionReader refuses_unknown(name, options(), given);
    return {values[0], values[1], values[2]};
  }

  T step(State& state, const Motion& motion, double) const noexcept {
    if (!state.started) {
      state.started = true;
      state.penetration = motion.penetration;
    }
    state.slip = state.slip + (motion.penetration - state.penetration) / presliding;
    if (state.slip > T(1.0)) state.slip = T(1.0);
    if (state.slip < T(-1.0)) state.slip = T(-1.0);
    state.penetration = motion.penetration;
    return stiffness * motion.penetration + coulomb * state.slip;
  }
};

}  // namespace kerf::models

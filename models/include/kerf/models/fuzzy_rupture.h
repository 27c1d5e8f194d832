#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/fuzzy.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// The rupture threshold of a FuzzySurface as a force of its own: what tissue would bear at this depth and
/// speed.
///
///     F = F_rupture(x, |v|)   for x > 0, else 0
///
/// Source: [FuzzyKelvin], section 2.2.
template <typename T>
struct FuzzyRupture {
  static constexpr std::string_view name = "fuzzy_rupture";
  static constexpr std::string_view equation = "F = sum w_i (p_i x + q_i |v| + r_i) / sum w_i";
  static constexpr std::string_view position_unit = "m";
  static constexpr std::string_view force_unit = "N";
  static constexpr LawFacts facts{
      .search = Search::threshold,
      .searched_at_once = 8,
      .from_data = FuzzySurface<T>::from_data(2.0),
      .size = FuzzySurface<T>::size,
      .fineness = Fineness::memberships,
      .variants = {{.options = {"memberships=2"}, .effects = {Effect::stiffening, Effect::rate}}}};

  FuzzySurface<T> surface;

  struct State {
    Signal<T> penetration = -std::numeric_limits<double>::infinity();

    /// The force goes on from nothing.
    template <typename Visit>
    void each(Visit&&) {}
  };

  static std::vector<OptionInfo> options() { return FuzzySurface<T>::options(); }
  static std::vector<ParameterInfo> parameters(const Options& given) {
    return FuzzySurface<T>::parameters(OptionReader(name, options(), given));
  }
  static FuzzyRupture make(std::span<const T> values, const Options& given) {
    return {FuzzySurface<T>::make(values, OptionReader(name, options(), given))};
  }

  /// Work of the force along the depth at rest [J], as if it were a spring. Not a bound: a force that grows
  /// with the speed gives more to a tool that leaves fast than it took from one that came slowly.
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return state.penetration > 0.0 ? surface.work_to(state.penetration, 0.0) : T(0.0);
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T>) const noexcept {
    state.penetration = motion.penetration;
    if (!(motion.penetration > 0.0)) return T(0.0);
    using std::abs;
    return surface(motion.penetration, abs(motion.velocity));
  }
};

}  // namespace kerf::models

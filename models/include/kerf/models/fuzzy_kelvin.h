#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/fuzzy.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Cutting as a row of ruptures: a Kelvin element stretched ahead of the blade until it breaks.
///
///     F = k1 (x - x_r) + f      Kelvin force since the last rupture, at x_r
///     F >= F_rupture(d, |v|):   the tissue ruptures: F = 0, f = 0, x_r = x
///
/// x is the travel in the direction of the cut, d the depth of the blade (an option: it is constant along the
/// cut), F_rupture a FuzzySurface. What was cut stays cut: behind x_r there is no force.
///
/// Source: [FuzzyKelvin], section 2.3, figs. 4-6; differs from the paper, where the force drops to "nearly"
/// zero, in that it drops to zero for the tick of the rupture.
template <typename T>
struct FuzzyKelvin {
  static constexpr std::string_view name = "fuzzy_kelvin";
  static constexpr std::string_view equation = "kelvin since the last rupture, up to F_rupture(d, |v|)";
  static constexpr std::string_view position_unit = "m";
  static constexpr std::string_view force_unit = "N";
  static constexpr LawFacts facts{
      .search = Search::ruptures,
      .searched_at_once = 8,
      .from_data = FuzzySurface<T>::from_data(1.0),
      // One membership spans the whole box, and the depth of the blade does not change along the cut: the
      // threshold is a line over the speed.
      .held = {"depth_", "speed_", "per_depth"},
      .size = FuzzySurface<T>::size,
      .fineness = Fineness::memberships,
      .variants = {
          {.options = {"memberships=1"}, .effects = {Effect::relaxation, Effect::rate, Effect::cutting}}}};

  Kelvin<T> element;
  FuzzySurface<T> surface;
  double depth = 0.005;  ///< d [m]

  struct State {
    typename Kelvin<T>::State element;
    Signal<T> reference = 0.0;  ///< x_r [m]
    std::uint32_t ruptures = 0;
    T rupture_force{0.0};  ///< Kelvin force at the last rupture [N]

    /// What the force goes on from, by name: ruptures are counted beside it.
    template <typename Visit>
    void each(Visit&& visit) {
      element.each(visit);
      visit("reference", reference);
    }
  };

  static std::vector<OptionInfo> options() {
    auto all = FuzzySurface<T>::options();
    all.insert(all.begin(), {{"depth", 0.005, "d, depth of the blade [m]"}});
    return all;
  }
  static std::vector<ParameterInfo> parameters(const Options& given) {
    auto all = Kelvin<T>::parameters({});
    const auto surface = FuzzySurface<T>::parameters(OptionReader(name, options(), given));
    all.insert(all.end(), surface.begin(), surface.end());
    return all;
  }
  static FuzzyKelvin make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    return {Kelvin<T>::make(values.first(3), {}), FuzzySurface<T>::make(values.subspan(3), reader),
            reader.number("depth", 0.0, 1e3)};
  }

  /// Of the element since the last rupture [J].
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return element.stored_energy(state.element);
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T> period_s) const noexcept {
    using std::abs;
    const T force =
        element.step(state.element, {motion.penetration - state.reference, motion.velocity}, period_s);
    if (!(force > T(0.0)) || force < surface(depth, abs(motion.velocity))) return force;
    ++state.ruptures;
    state.rupture_force = force;
    state.reference = motion.penetration;
    state.element.rupture();
    return T(0.0);
  }
};

}  // namespace kerf::models

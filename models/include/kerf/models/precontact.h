#pragma once

#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Elastic feedback that begins a little before the surface, so that contact is met softly.
///
///     smooth:  F = K d^2 / (2 w)   up to the surface,   K (d - w/2)   beyond
///     paper:   F = K d^2 / w       up to the surface,   K d           beyond
///
/// d = x + w is the depth past the threshold, w the distance from the threshold to the surface (x = 0); no
/// force before the threshold. Both are continuous; the form that the paper prints drops its slope from 2 K
/// to K at the surface, `smooth` is also continuous in slope and the default.
///
/// Source: [Henry2004], eq. 2, with x0 = -w, xm = 0, Kemax = K; differs from the paper in the default form.
template <typename T>
struct Precontact {
  static constexpr std::string_view name = "precontact";
  static constexpr std::string_view equation = "F = K d^2 / (2 w) before the surface, K (d - w/2) past it";
  static constexpr LawFacts facts{.search = Search::descent,
                                  .scan = {.over = Scan::values,
                                           .parameter = "width",
                                           .values = {0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 2.0},
                                           .unit = ScanUnit::depth,
                                           .has_a_kink = true},
                                  .variants = {{.effects = {Effect::stiffening}}}};

  T stiffness{};  ///< K [N/m], > 0
  T width{};      ///< w [m], > 0
  bool paper = false;

  struct State {
    Signal<T> penetration = -std::numeric_limits<double>::infinity();

    /// The force goes on from nothing.
    template <typename Visit>
    void each(Visit&&) {}
  };

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {
        {"stiffness", Quantity::stiffness, 1e-9, 1e9, Scale::logarithmic, "K, of the tissue itself"},
        {"width", Quantity::position, 1e-9, 1e3, Scale::logarithmic, "w, from the threshold to the surface"}};
  }
  static std::vector<OptionInfo> options() {
    return {{"form", std::string("smooth"), "smooth (continuous slope) or paper (as printed)"}};
  }
  static Precontact make(std::span<const T> values, const Options& given) {
    const std::string form = OptionReader(name, options(), given).choice("form", {"smooth", "paper"});
    return {values[0], values[1], form == "paper"};
  }

  /// Elastic energy since the threshold [J].
  [[nodiscard]] T stored_energy(double penetration) const noexcept {
    const T d = penetration + width;
    if (d <= T(0.0)) return T(0.0);
    const T share = paper ? T(1.0) : T(0.5);
    if (penetration <= 0.0) return share * stiffness * d * d * d / (3.0 * width);
    const T at_surface = share * stiffness * width * width / 3.0;
    return at_surface + 0.5 * stiffness * (d * d - width * width) -
           (paper ? T(0.0) : T(0.5 * stiffness * width * penetration));
  }

  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return stored_energy(state.penetration);
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T>) const noexcept {
    state.penetration = motion.penetration;
    const T d = motion.penetration + width;
    if (d <= T(0.0)) return T(0.0);
    const T share = paper ? T(1.0) : T(0.5);
    if (motion.penetration <= 0.0) return share * stiffness * d * d / width;
    return stiffness * (paper ? d : T(d - 0.5 * width));
  }
};

}  // namespace kerf::models

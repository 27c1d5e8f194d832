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

/// Contact whose damping grows with the depth, as its stiffness does: no jump where contact begins or ends.
///
///     F = (F1 + B1 v) (x / x1)^n   for x > 0 and where that is not negative, else 0
///
/// x1 [m] is a reference depth, a setting that only scales: F1 [N] is the force there at rest, B1 [N·s/m] the
/// force per speed, n [1] the exponent (1.5 for spheres of Hertz). In the usual form F = k x^n + b x^n v,
/// whose units change with n, k = F1 / x1^n and b = B1 / x1^n. B1 is signed, since some tissue resists less
/// when it is met faster.
///
/// A mass that meets it at the speed v1 leaves at v0 with q v1 - log(1 + q v1) = -q v0 - log(1 - q v0), q =
/// B1 / F1, whatever n and the mass: to first order v0 / v1 = 1 - (2/3) q v1, and a share (4/3) q v1 of the
/// energy is lost. Passive for B1 >= 0. The force depends on depth and speed alone, so that the period does
/// not enter.
///
/// Source: [HuntCrossley1975].
template <typename T>
struct HuntCrossley {
  static constexpr std::string_view name = "hunt_crossley";
  static constexpr std::string_view equation = "F = (F1 + B1 v) (x / x1)^n";
  static constexpr LawFacts facts{
      .search = Search::descent,
      .scan = {.over = Scan::values, .parameter = "exponent", .values = {0.7, 1.0, 1.5, 2.0, 2.7, 3.5, 4.5}},
      .from_data = {{"reference_depth", From::depth}},
      .in_float = true,
      .charted = true,
      .variants = {{.effects = {Effect::stiffening, Effect::rate}}}};

  T reference_force{};            ///< F1 [N], > 0
  T reference_damping{};          ///< B1 [N·s/m]
  T exponent{};                   ///< n [1]
  double reference_depth = 0.01;  ///< x1 [m or rad], > 0

  struct State {
    Signal<T> penetration = -std::numeric_limits<double>::infinity();

    /// The force goes on from nothing.
    template <typename Visit>
    void each(Visit&&) {}
  };

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {{"reference_force", Quantity::force, 1e-15, 1e6, Scale::logarithmic,
             "F1, force at rest at the reference depth"},
            {"reference_damping", Quantity::damping, -1e6, 1e6, Scale::linear,
             "B1, force per speed at the reference depth"},
            {"exponent", Quantity::ratio, 0.5, 5.0, Scale::linear, "n, power of the depth"}};
  }
  static std::vector<OptionInfo> options() {
    return {{"reference_depth", 0.01, "x1, depth at which force and damping are given, in position's unit"},
            precision_option()};
  }
  static HuntCrossley make(std::span<const T> values, const Options& given) {
    return {values[0], values[1], values[2],
            OptionReader(name, options(), given).number("reference_depth", 1e-9, 1e9)};
  }

  /// Elastic energy at a depth [J].
  [[nodiscard]] T stored_energy(double penetration) const noexcept {
    if (penetration <= 0.0) return T(0);
    return reference_force * static_cast<Input<T>>(penetration) / (exponent + Input<T>(1)) *
           share(penetration);
  }
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return stored_energy(state.penetration);
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T>) const noexcept {
    state.penetration = motion.penetration;
    if (motion.penetration <= 0.0) return T(0);
    const T at_reference = reference_force + reference_damping * static_cast<Input<T>>(motion.velocity);
    return at_reference < T(0) ? T(0) : T(at_reference * share(motion.penetration));
  }

 private:
  /// (x / x1)^n
  [[nodiscard]] T share(Signal<T> penetration) const noexcept {
    using std::pow;
    return pow(static_cast<Input<T>>(penetration / reference_depth), exponent);
  }
};

}  // namespace kerf::models

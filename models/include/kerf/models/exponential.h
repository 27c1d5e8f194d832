#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Exponentially stiffening tissue with viscosity.
///
///     F = F0 + alpha exp(beta x / L0) + B0 v   for x > 0, else F0
///
/// With the option `zero_at_contact` the elastic part is alpha (exp(beta x / L0) - 1). L0 is the sample's
/// thickness: it only scales beta, so it is a setting and not fitted. B0 is signed, since some tissue
/// resists less when it is cut faster; without the option `viscous` there is none. The option `offset` adds
/// F0 [N], of either sign, in contact and before it: the bias of a force sensor. The stiffness, beta / L0
/// times the exponential part, grows with the force: past some depth no sampled loop renders it passively.
/// Passive for B0 >= 0; the offset gives back over a closed path what it took.
///
/// Source: [Sepulveda2008], eqs. 11-13, whose B0 enters the closed loop as an acceleration term; here it is
/// N·s/m. The offset is not in the paper.
template <typename T>
struct Exponential {
  static constexpr std::string_view name = "exponential";
  static constexpr std::string_view equation = "F = alpha exp(beta x / L0) + B0 v";
  static constexpr LawFacts facts{
      .search = Search::descent,
      .scan = {.over = Scan::values,
               .parameter = "exponent",
               .values = {0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 20.0},
               .unit = ScanUnit::per_depth,
               .option = "thickness"},
      .in_float = true,
      .usual = 2,
      .charted = true,
      .variants = {{.suffix = "-elastic", .options = {"viscous=false"}, .effects = {Effect::stiffening}},
                   {.effects = {Effect::stiffening, Effect::rate}},
                   {.suffix = "-offset",
                    .options = {"offset=true"},
                    .effects = {Effect::stiffening, Effect::rate}}},
      .rank = -2};

  T amplitude{};           ///< alpha [N], > 0
  T exponent{};            ///< beta [1], > 0
  T viscosity{};           ///< B0 [N·s/m]
  double thickness = 0.1;  ///< L0 [m or rad], > 0
  bool zero_at_contact = false;
  T offset{};  ///< F0 [N]

  struct State {
    Signal<T> penetration = -std::numeric_limits<double>::infinity();

    /// The force goes on from nothing.
    template <typename Visit>
    void each(Visit&&) {}
  };

  static std::vector<ParameterInfo> parameters(const Options& given) {
    const OptionReader reader(name, options(), given);
    std::vector<ParameterInfo> all{
        {"amplitude", Quantity::force, 1e-15, 1e6, Scale::logarithmic, "alpha, force at contact"},
        {"exponent", Quantity::ratio, 1e-6, 1e3, Scale::logarithmic,
         "beta, stiffening over the thickness L0"}};
    if (reader.flag("viscous")) {
      all.push_back({"viscosity", Quantity::damping, -1e6, 1e6, Scale::linear, "B0, force per speed"});
    }
    if (reader.flag("offset")) {
      all.push_back(
          {"offset", Quantity::force, -1e6, 1e6, Scale::linear, "F0, force that is there without contact"});
    }
    return all;
  }
  static std::vector<OptionInfo> options() {
    return {{"thickness", 0.1, "L0, thickness of the sample in the unit of position"},
            {"zero_at_contact", false, "subtract alpha, so that the force begins at zero"},
            {"viscous", true, "a force per speed"},
            {"offset", false, "a constant force, in contact and before it"},
            precision_option()};
  }
  static Exponential make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    Exponential law{.amplitude = values[0],
                    .exponent = values[1],
                    .thickness = reader.number("thickness", 1e-9, 1e9),
                    .zero_at_contact = reader.flag("zero_at_contact")};
    std::size_t next = 2;
    if (reader.flag("viscous")) law.viscosity = values[next++];
    if (reader.flag("offset")) law.offset = values[next];
    return law;
  }

  /// Elastic part of the force [N].
  [[nodiscard]] T elastic_force(Signal<T> penetration) const {
    using std::exp;
    using std::expm1;
    if (penetration <= 0.0) return T(0);
    const T growth = exponent * static_cast<Input<T>>(penetration / thickness);
    return zero_at_contact ? T(amplitude * expm1(growth)) : T(amplitude * exp(growth));
  }
  /// dF/dx [N/m]
  [[nodiscard]] T stiffness(double penetration) const {
    using std::exp;
    return amplitude * exponent / thickness * exp(exponent * (penetration / thickness));
  }
  /// Penetration at which the tissue is as stiff as this, >= 0 [m]. A sampled loop on a device of damping b
  /// renders springs passively up to 2 b / T [ColgateSchenkel1997]: so deep this law may go there.
  [[nodiscard]] T depth_at_stiffness(double stiffness_n_per_m) const {
    using std::log;
    const T depth = thickness / exponent * log(stiffness_n_per_m * thickness / (amplitude * exponent));
    return depth > T(0.0) ? depth : T(0.0);
  }
  /// Elastic energy since contact [J]. The offset is the sensor's, and none of it.
  [[nodiscard]] T stored_energy(double penetration) const noexcept {
    using std::expm1;
    if (penetration <= 0.0) return T(0);
    const T whole = amplitude * static_cast<Input<T>>(thickness) / exponent *
                    expm1(exponent * static_cast<Input<T>>(penetration / thickness));
    return zero_at_contact ? T(whole - amplitude * static_cast<Input<T>>(penetration)) : whole;
  }
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return stored_energy(state.penetration);
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T>) const noexcept {
    state.penetration = motion.penetration;
    if (motion.penetration <= 0.0) return offset;
    return offset + (elastic_force(motion.penetration) + viscosity * static_cast<Input<T>>(motion.velocity));
  }
};

}  // namespace kerf::models

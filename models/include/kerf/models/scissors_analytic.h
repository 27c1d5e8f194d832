#pragma once

#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/branch.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/scissors.h>

namespace kerf::models {

/// Analytical scissors: friction at the pivot, friction between the blades, and cutting at the point where
/// they cross, all felt at the handle.
///
///     f_h = s (tau_pf + f_bf x_c(theta)) / l_h            friction, against the motion
///         + f_cf x_c(theta) / l_h                         while closing in the material
///
/// x_c is the distance of the cutting point from the pivot (ScissorsGeometry), theta = contact_angle - x the
/// angle between the blades, l_h the lever of the handle, s = +1 closing and -1 opening, both terms times the
/// factor of a BranchSelector. The material is met at x = 0. Zero outside the angles at which the blades
/// cut. Linear in all three parameters.
///
/// Source: [Okamura2003], eqs. 6-9; the lever 0.28 N·m / 7.58 N from its section 3.
template <typename T>
struct ScissorsAnalytic {
  static constexpr std::string_view name = "scissors_analytic";
  static constexpr std::string_view equation = "F = s (tau_pf + f_bf x_c) / l_h + f_cf x_c / l_h";
  static constexpr std::string_view position_unit = "rad";
  static constexpr std::string_view force_unit = "N";
  static constexpr LawFacts facts{
      .search = Search::descent,
      .from_data = {{"contact_angle", From::contact}},
      .variants = {{.effects = {Effect::loop, Effect::cutting, Effect::stiffening}}}};

  T pivot_torque{};    ///< tau_pf [N·m]
  T blade_friction{};  ///< f_bf [N]
  T cutting_force{};   ///< f_cf [N]
  double contact_angle_rad = 0.5;
  double lever_m = 0.28 / 7.58;
  CuttingPoint point;
  BranchSelector selector;

  using State = BranchSelector::StateOf<Signal<T>>;

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {{"pivot_torque", Quantity::torque, 0.0, 1e3, Scale::linear, "tau_pf, friction at the pivot"},
            {"blade_friction", Quantity::load, 0.0, 1e6, Scale::linear, "f_bf, friction between the blades"},
            {"cutting_force", Quantity::load, 0.0, 1e6, Scale::linear, "f_cf, at the cutting point"}};
  }
  static std::vector<OptionInfo> options() {
    std::vector<OptionInfo> all{
        {"contact_angle", 0.5, "angle between the blades where they meet the material, x = 0 [rad]"},
        {"lever", 0.28 / 7.58, "l_h, of the handle [m]"}};
    for (const auto& more : {ScissorsGeometry::options(), BranchSelector::options()}) {
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }
  static ScissorsAnalytic make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    ScissorsAnalytic law{values[0], values[1], values[2]};
    law.contact_angle_rad = reader.number("contact_angle", 0.0, 3.1);
    law.lever_m = reader.number("lever", 1e-6, 10.0);
    law.point = CuttingPoint(ScissorsGeometry::make(reader));
    law.selector = BranchSelector::make(reader);
    return law;
  }

  /// Friction and cutting hold nothing [N·rad].
  [[nodiscard]] T stored_energy(const State&) const noexcept { return T(0.0); }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T> period_s) const noexcept {
    const auto branch = selector.step(state, motion, period_s);
    const Signal<T> theta = contact_angle_rad - motion.penetration;
    if (!point.cuts_at(theta)) return T(0.0);
    const Signal<T> x_c = point(theta);
    const T friction = pivot_torque + blade_friction * x_c;
    if (!branch.closing) return -branch.scale / lever_m * friction;
    const T cutting = motion.penetration > 0.0 ? T(cutting_force * x_c) : T(0.0);
    return branch.scale / lever_m * (friction + cutting);
  }
};

}  // namespace kerf::models

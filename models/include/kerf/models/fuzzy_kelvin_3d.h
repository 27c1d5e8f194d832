#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/contact_energy.h>
#include <kerf/models/fuzzy.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/spatial.h>

namespace kerf::models {

/// Cutting with a blade that is free in x, y and z: three Kelvin elements and one rupture threshold.
///
///     f_i = -(1 + c d) kelvin_i(p_i - p_r,i),   i = x, y
///     f_z = (1 + c d) kelvin_z(p_r,z - z) + c (U_x + U_y)
///     (1 + c d) kelvin_x >= F_rupture(d, |v|):  the tissue ruptures, p_r = p
///
/// The tissue is z < 0, the cut runs along +x, d = max(0, -z) is the depth. The elements of x and y act both
/// directions while the blade is in the tissue; that of z resists going deeper. c lets all three stiffen with
/// depth. The threshold is that of fuzzy_kelvin, met by the force against the cut alone. Above the surface
/// there is no force, and the reference goes with the blade.
///
/// U_i = k1 e^2 / 2 + k2 s^2 / 2 is what the two springs of an element hold at the strains e of the element
/// and s of its arm. The term c U is what makes the law passive: lateral forces that stiffen with the depth
/// are those of V = (1 + c d) (U_x + U_y), and whoever deepens pays for it by dV/dd. Then
///
///     V' = (1 + c d) (kelvin_x e_x' + kelvin_y e_y' - losses) + c d' (U_x + U_y)
///
/// is the power of the hand less what the dashpots take. Along the depth nothing need be added: the springs
/// are strained by the depth that stiffens them, and hold
///
///     W = int (1 + c D) k (D - m) dD from m to d = (1 + c d - c s / 3) k s^2 / 2,   s = d - m
///
/// (m = p_r for k1, the dashpot for k2); the dashpot follows, so that dW/dm m' <= 0. The option `form =
/// "paper"` leaves c U out, as the paper's parameters that change with depth do: it renders what is printed,
/// and a hand that goes sideways when shallow and back when deep is given energy.
///
/// Source: [FuzzyKelvin], section 2.3, whose three elements have no numbers of their own; figs. 4-6 are of
/// the x axis; differs from the paper in c U.
struct FuzzyKelvin3d {
  static constexpr std::string_view name = "fuzzy_kelvin_3d";
  static constexpr std::string_view equation =
      "three fuzzy_kelvin elements, along the cut, across it and in depth";
  static constexpr LawFacts facts{.size = FuzzySurface<double>::size, .fineness = Fineness::memberships};

  std::array<Kelvin<double>, 3> element;
  double stiffening_per_m = 0.0;  ///< c
  bool paper = false;             ///< without c U
  FuzzySurface<double> surface;

  struct State {
    std::array<Kelvin<double>::State, 3> element;
    std::array<double, 3> reference{};
    double depth = 0.0;            ///< d [m]
    double held_in_depth_j = 0.0;  ///< W, as far as the hand paid for it
    bool in_tissue = false;
    std::uint32_t ruptures = 0;
  };

  static std::vector<LawAxis> axes() { return {{"x", "m", "N"}, {"y", "m", "N"}, {"z", "m", "N"}}; }
  static std::vector<OptionInfo> options() {
    auto all = FuzzySurface<double>::options();
    all.push_back({"stiffening", 0.0, "c, growth of all stiffness with depth [1/m]"});
    all.push_back({"form", std::string("passive"),
                   "passive, or paper (deepening under a lateral strain is free: creates energy)"});
    return all;
  }
  static std::vector<ParameterInfo> parameters(const Options& given) {
    std::vector<ParameterInfo> all;
    for (const auto& info : Kelvin<double>::parameters({})) {
      for (const char* axis : {"_x", "_y", "_z"}) {
        all.push_back(info);
        all.back().name += axis;
      }
    }
    const auto surface = FuzzySurface<double>::parameters(OptionReader(name, options(), given));
    all.insert(all.end(), surface.begin(), surface.end());
    return all;
  }
  static FuzzyKelvin3d make(std::span<const double> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    FuzzyKelvin3d law;
    for (std::size_t i = 0; i < 3; ++i) {
      law.element[i] = {values[i], values[3 + i], values[6 + i]};
    }
    law.stiffening_per_m = reader.number("stiffening", 0.0, 1e6);
    law.paper = reader.choice("form", {"passive", "paper"}) == "paper";
    law.surface = FuzzySurface<double>::make(values.subspan(9), reader);
    return law;
  }

  /// V + W since the last rupture [J].
  [[nodiscard]] double stored_energy(const State& state) const noexcept {
    if (!state.in_tissue) return 0.0;
    return share(state.depth) * lateral_energy(state) + state.held_in_depth_j;
  }

  AxisValues step(State& state, const SpatialMotion& motion, double period_s) const noexcept {
    const auto& p = motion.position;
    const double depth_before = state.depth;
    state.depth = p[2] < 0.0 ? -p[2] : 0.0;
    if (!(state.depth > 0.0)) state.in_tissue = false;
    if (state.depth > 0.0 && !state.in_tissue) enter(state, p);
    if (!state.in_tissue) return {};
    AxisValues force{};
    for (std::size_t i = 0; i < 2; ++i) {
      force[i] = -share(state.depth) *
                 element[i].bilateral_step(state.element[i], p[i] - state.reference[i], period_s);
    }
    force[2] = step_in_depth(state, state.reference[2] - p[2], depth_before, period_s);
    if (!paper) force[2] += stiffening_per_m * lateral_energy(state);
    if (!ruptures(-force[0], state.depth, motion.velocity)) return force;
    ++state.ruptures;
    begin_anew(state, p);
    return {};
  }

 private:
  [[nodiscard]] double share(double depth) const noexcept { return 1.0 + stiffening_per_m * depth; }
  /// U_x + U_y [J]
  [[nodiscard]] double lateral_energy(const State& state) const noexcept {
    return element[0].spring_energy(state.element[0]) + element[1].spring_energy(state.element[1]);
  }
  /// W [J]
  [[nodiscard]] double energy_in_depth(const State& state) const noexcept {
    const Kelvin<double>::State& along = state.element[2];
    const auto held = [&](double stiffness, double strain) {
      return 0.5 * stiffness * strain * strain * (share(state.depth) - stiffening_per_m * strain / 3.0);
    };
    return held(element[2].parallel_stiffness, along.penetration) +
           held(element[2].series_stiffness, along.arm_force / element[2].series_stiffness);
  }
  [[nodiscard]] bool ruptures(double against_cut, double depth, const AxisValues& velocity) const noexcept {
    return against_cut > 0.0 &&
           against_cut >= surface(depth, std::hypot(velocity[0], velocity[1], velocity[2]));
  }

  static void enter(State& state, const AxisValues& p) noexcept {
    state.element = {};
    state.element[2].started = true;  // it was touched at the surface, wherever the first tick finds it
    state.held_in_depth_j = 0.0;
    state.reference = {p[0], p[1], 0.0};
    state.in_tissue = true;
  }
  static void begin_anew(State& state, const AxisValues& p) noexcept {
    state.reference = {p[0], p[1], p[2]};
    state.held_in_depth_j = 0.0;
    for (auto& one : state.element) one.rupture();
  }
  /// Force along the depth without c U; the books of W are those of contact_step(), at moduli that change.
  double step_in_depth(State& state, double travel, double depth_before, double period_s) const noexcept {
    Kelvin<double>::State& along = state.element[2];
    const double from_m = along.penetration;
    const double from_n = share(depth_before) * element[2].held_force(along);
    const double force = share(state.depth) * element[2].step(along, {travel, 0.0}, period_s);
    const double to_n = share(state.depth) * element[2].held_force(along);
    const double all = energy_in_depth(state);
    const double paid = state.held_in_depth_j + felt_work(from_n, to_n, along.penetration - from_m);
    state.held_in_depth_j = along.reachable < 0.0 ? all : std::clamp(paid, 0.0, all);
    return force;
  }
};

}  // namespace kerf::models

#pragma once

#include <array>
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
#include <kerf/models/spatial.h>

namespace kerf::models {

/// Cutting with a blade that is free in x, y and z: three Kelvin elements and one rupture threshold.
///
///     f_i = -(1 + c d) kelvin_i(p_i - p_r,i),   i = x, y, z
///     (1 + c d) kelvin_x >= F_rupture(d, |v|):  the tissue ruptures, p_r = p
///
/// The tissue is z < 0, the cut runs along +x, d = max(0, -z) is the depth. The elements of x and y act both
/// directions while the blade is in the tissue; that of z resists going deeper. c lets all three stiffen with
/// depth. The threshold is that of fuzzy_kelvin, met by the force against the cut alone. Above the surface
/// there is no force, and the reference goes with the blade.
///
/// Passive without stiffening. With c > 0 it is not: deepening raises the lateral forces without a force
/// along the depth that pays for it, as the paper's parameters that change with depth do.
///
/// Source: [FuzzyKelvin], section 2.3, whose three elements have no numbers of their own; figs. 4-6 are of
/// the x axis.
struct FuzzyKelvin3d {
  static constexpr std::string_view name = "fuzzy_kelvin_3d";
  static constexpr std::string_view equation =
      "three fuzzy_kelvin elements, along the cut, across it and in depth";
  static constexpr LawFacts facts{.size = FuzzySurface<double>::size, .fineness = Fineness::memberships};

  std::array<Kelvin<double>, 3> element;
  double stiffening_per_m = 0.0;  ///< c
  FuzzySurface<double> surface;

  struct State {
    std::array<Kelvin<double>::State, 3> element;
    std::array<double, 3> reference{};
    double depth = 0.0;  ///< d [m]
    bool in_tissue = false;
    std::uint32_t ruptures = 0;
  };

  static std::vector<LawAxis> axes() { return {{"x", "m", "N"}, {"y", "m", "N"}, {"z", "m", "N"}}; }
  static std::vector<OptionInfo> options() {
    auto all = FuzzySurface<double>::options();
    all.push_back({"stiffening", 0.0, "c, growth of all stiffness with depth [1/m]"});
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
    law.surface = FuzzySurface<double>::make(values.subspan(9), reader);
    return law;
  }

  /// Of the three elements since the last rupture, (1 + c d) times what they hold [J].
  [[nodiscard]] double stored_energy(const State& state) const noexcept {
    if (!state.in_tissue) return 0.0;
    double energy = 0.0;
    for (std::size_t i = 0; i < 3; ++i) energy += element[i].stored_energy(state.element[i]);
    return (1.0 + stiffening_per_m * state.depth) * energy;
  }

  AxisValues step(State& state, const SpatialMotion& motion, double period_s) const noexcept {
    const auto& p = motion.position;
    const double depth = p[2] < 0.0 ? -p[2] : 0.0;
    state.depth = depth;
    if (!(depth > 0.0)) state.in_tissue = false;
    if (depth > 0.0 && !state.in_tissue) {
      state.element = {};
      state.element[2].started = true;  // it was touched at the surface, wherever the first tick finds it
      state.reference = {p[0], p[1], 0.0};
      state.in_tissue = true;
    }
    if (!state.in_tissue) return {};
    const double share = 1.0 + stiffening_per_m * depth;
    AxisValues force{};
    double against_cut = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double travel = i == 2 ? state.reference[2] - p[2] : p[i] - state.reference[i];
      const double resisting =
          share * (i == 2 ? element[2].step(state.element[2], {travel, 0.0}, period_s)
                          : element[i].bilateral_step(state.element[i], travel, period_s));
      force[i] = i == 2 ? resisting : -resisting;
      if (i == 0) against_cut = resisting;
    }
    if (against_cut > 0.0) {
      const double speed = std::hypot(motion.velocity[0], motion.velocity[1], motion.velocity[2]);
      if (against_cut >= surface(depth, speed)) {
        ++state.ruptures;
        state.reference = {p[0], p[1], p[2]};
        for (auto& one : state.element) {
          one.arm_force = 0.0;
          one.penetration = 0.0;
          one.reachable = -1.0;
        }
        return {};
      }
    }
    return force;
  }
};

}  // namespace kerf::models

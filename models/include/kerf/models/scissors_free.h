#pragma once

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/branch.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/scissors.h>
#include <kerf/models/spatial.h>

namespace kerf::models {

/// The edge of the material before a pair of scissors that may also be pushed forward:
///
///     contact:  x_c + x_s > x_m
///     f_t = k_t (x_m - x_c - x_s)              pushes back, at most f_max
///     k_t (x_c + x_s - x_m) > f_max:           the edge gives way, x_m = x_c + x_s - f_max / k_t
///
/// x_c is the distance of the cutting point from the pivot, x_s the translation of the scissors, x_m where
/// the material begins. What gave way was cut: the edge never comes back.
///
/// Source: [Okamura2003], section 2.3 and fig. 5.
struct MaterialEdge {
  double stiffness_n_per_m = 1000.0;  ///< k_t, > 0
  double largest_force_n = 2.0;       ///< f_max, >= 0

  struct State {
    double edge_m = 0.0;    ///< x_m
    double pushed_m = 0.0;  ///< by which the cutting point stands beyond it
  };
  struct Answer {
    bool contact = false;
    double force_n = 0.0;  ///< f_t, on x_s, <= 0
  };

  /// @param cutting_point_m x_c + x_s
  Answer step(State& state, double cutting_point_m) const noexcept {
    const double pushed = state.pushed_m = std::max(0.0, cutting_point_m - state.edge_m);
    if (!(pushed > 0.0)) return {};
    if (stiffness_n_per_m * pushed <= largest_force_n) return {true, -stiffness_n_per_m * pushed};
    state.pushed_m = largest_force_n / stiffness_n_per_m;
    state.edge_m = cutting_point_m - state.pushed_m;
    return {true, -largest_force_n};
  }
};

/// Scissors that open, close and move forward: the analytical law of the handle (scissors_analytic) with
/// contact taken from the material's edge, and the force of that edge on the translation.
///
///     f_h = s (tau_pf + f_bf x_c) / l_h + f_cf x_c / l_h in contact,   f_t = k_t (x_m - x_c - x_s)
///
/// Axes: theta [rad], force in N at the handle, and x_s [m]. s = -1 for closing, since closing makes theta
/// smaller and friction pushes it up. Where the blades do not cut there is neither force.
///
/// Source: [Okamura2003], eqs. 1-3 and 6-9, section 2.3.
struct ScissorsFree {
  static constexpr std::string_view name = "scissors";
  static constexpr std::string_view equation =
      "scissors_analytic on theta, k_t (x_m - x_c - x_s) up to f_max on x_s";
  static constexpr LawFacts facts{};

  double pivot_torque = 0.0;    ///< tau_pf [N·m]
  double blade_friction = 0.0;  ///< f_bf [N]
  double cutting_force = 0.0;   ///< f_cf [N]
  MaterialEdge material;
  double edge_m = 0.0;
  double lever_m = 0.28 / 7.58;
  CuttingPoint point;
  BranchSelector selector;

  struct State {
    BranchSelector::State branch;
    MaterialEdge::State material;
  };

  static std::vector<LawAxis> axes() { return {{"theta", "rad", "N"}, {"x_s", "m", "N"}}; }
  static std::vector<OptionInfo> options();
  static std::vector<ParameterInfo> parameters(const Options& given);
  static ScissorsFree make(std::span<const double> values, const Options& given);

  [[nodiscard]] State initial_state() const { return {.branch = {}, .material = {.edge_m = edge_m}}; }
  /// Of the edge, k_t (x_c + x_s - x_m)^2 / 2 [J]: x_s gives it back. Closing also pushes the cutting point
  /// against the edge, which the handle does not feel: where its friction takes less than the edge gains by
  /// it, the two axes together give more than they took.
  [[nodiscard]] double stored_energy(const State& state) const noexcept {
    return 0.5 * material.stiffness_n_per_m * state.material.pushed_m * state.material.pushed_m;
  }
  AxisValues step(State& state, const SpatialMotion& motion, double period_s) const noexcept;
};

}  // namespace kerf::models

#include "kerf/models/scissors_free.h"

#include "kerf/models/scissors_analytic.h"

namespace kerf::models {

std::vector<OptionInfo> ScissorsFree::options() {
  std::vector<OptionInfo> all{
      {"edge", 0.03, "x_m, where the material begins, from the pivot at x_s = 0 [m]"}};
  for (const OptionInfo& option : ScissorsAnalytic<double>::options()) {
    if (option.name != "contact_angle") all.push_back(option);
  }
  return all;
}

std::vector<ParameterInfo> ScissorsFree::parameters(const Options& given) {
  const OptionReader refuses_unknown(name, options(), given);
  auto all = ScissorsAnalytic<double>::parameters({});
  all.push_back(
      {"edge_stiffness", Quantity::spring, 1e-3, 1e6, Scale::logarithmic, "k_t, of the material's edge"});
  all.push_back(
      {"largest_force", Quantity::load, 0.0, 1e4, Scale::linear, "f_max, the edge gives way above it"});
  return all;
}

ScissorsFree ScissorsFree::make(std::span<const double> values, const Options& given) {
  const OptionReader reader(name, options(), given);
  return {.pivot_torque = values[0],
          .blade_friction = values[1],
          .cutting_force = values[2],
          .material = {.stiffness_n_per_m = values[3], .largest_force_n = values[4]},
          .edge_m = reader.number("edge", -10.0, 10.0),
          .lever_m = reader.number("lever", 1e-6, 10.0),
          .point = CuttingPoint(ScissorsGeometry::make(reader)),
          .selector = BranchSelector::make(reader)};
}

AxisValues ScissorsFree::step(State& state, const SpatialMotion& motion, double period_s) const noexcept {
  const double theta = motion.position[0];
  // Closing is the direction into the material, so that the selector's penetration is -theta.
  const auto branch = selector.step(state.branch, Motion{-theta, -motion.velocity[0]}, period_s);
  if (!point.cuts_at(theta)) {
    state.material.pushed_m = 0.0;
    return {};
  }
  const double x_c = point(theta);
  const auto edge = material.step(state.material, x_c + motion.position[1]);
  const double friction = pivot_torque + blade_friction * x_c;
  const double cutting = edge.contact && branch.closing ? cutting_force * x_c : 0.0;
  const double handle = branch.scale / lever_m * (branch.closing ? friction + cutting : -friction);
  return {handle, edge.force_n};
}

}  // namespace kerf::models

#include "stability/several/directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <system_error>

#include "stability/bisection.h"
#include "stability/several/matrices.h"
#include "stability/wall/wall_theory.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

using Eigen::MatrixXd;

/// Motions that grow by less than this in a tick do not grow: a direction without any spring stays where it
/// is, at an eigenvalue of 1 that rounding moves.
constexpr double still = 1e-10;

/// The wall at a direction with a stiffness.
TurningWall wall_of(const TurningWall& shape, double angle_rad, double stiffness) {
  TurningWall wall = shape;
  const Eigen::Index axes = wall.wall.stiffness.rows();
  if (axes > 1) {
    const MatrixXd turn = rotation_in_plane(axes, wall.first_axis, wall.second_axis, angle_rad);
    wall.wall.stiffness = (turn * wall.wall.stiffness * turn.transpose()).eval();
    wall.wall.damping = (turn * wall.wall.damping * turn.transpose()).eval();
  }
  wall.wall.stiffness *= stiffness;
  return wall;
}

/// One axis along a direction, the others left free: mass 1 / (n^T M^-1 n), the rest n^T A n.
double along_one_axis(const NamedAxes& axes, const TurningWall& shape, double angle_rad, Range searched) {
  const SampledAxes device = axes.in_hand();
  Eigen::VectorXd n = Eigen::VectorXd::Zero(device.axes());
  n(shape.first_axis) = std::cos(angle_rad);
  if (device.axes() > 1) n(shape.second_axis) = std::sin(angle_rad);
  SampledDevice one{.mass_kg = 1.0 / n.dot(divided_by(device.mass, n).col(0)),
                    .viscous_n_s_per_m = n.dot(device.damping * n),
                    .period_s = device.period_s,
                    .delay_s = device.delay_s,
                    .velocity_corner_rad_s = device.velocity_corner_rad_s,
                    .hand = {}};
  if (device.stiffness.size() > 0) one.hand.stiffness_n_per_m = n.dot(device.stiffness * n);
  const WallOfAxes wall = wall_at(wall_of(shape, angle_rad, 1.0), 0.0);
  const double share = n.dot(wall.stiffness * n);
  if (!(share > 0.0)) return searched.end;
  const double reached =
      eigenvalue_boundary(one, n.dot(wall.damping * n), searched.begin * share, searched.end * share);
  return reached / share;
}

DirectionBoundary boundary_at(const NamedAxes& axes, const SystemOfAxes& system, const TurningWall& shape,
                              double angle_rad, Range searched) {
  const SampledAxes device = axes.in_hand();
  const double period_s = device.period_s;
  const Search search{.lower = searched.begin, .upper = searched.end, .share = 1e-8, .scan = 24};
  const auto wall = [&](double stiffness) { return wall_of(shape, angle_rad, stiffness); };
  const auto first = [&](const auto& holds) {
    const double found = first_change(search, holds);
    return found <= searched.begin ? 0.0 : found;
  };
  return {.angle_rad = angle_rad,
          .eigenvalues = first([&](double k) { return growth(system, wall(k), period_s) < still; }),
          .simulated = first([&](double k) { return simulated_growth(system, wall(k), period_s) < still; }),
          .sufficient = first([&](double k) { return sufficient_condition(device, wall(k)).holds(); }),
          .passive = shape.turns() ? 0.0 : first([&](double k) {
            const SufficientCondition alone = sufficient_condition(axes.device, wall(k));
            return alone.turning_per_s2 == 0.0 && alone.holds();
          }),
          .one_axis = along_one_axis(axes, shape, angle_rad, searched)};
}

}  // namespace

SampledAxes NamedAxes::in_hand() const {
  SampledAxes both = device;
  if (hand_mass.size() > 0) both.mass += hand_mass;
  if (hand_damping.size() > 0) both.damping += hand_damping;
  if (hand_stiffness.size() > 0) both.stiffness = hand_stiffness;
  return both;
}

double DirectionMap::boundary_error() const {
  double worst = 0.0;
  for (const DirectionBoundary& at : boundaries) {
    if (at.eigenvalues <= searched.begin || at.eigenvalues >= searched.end) continue;
    worst = std::max(worst, std::abs(at.simulated / at.eigenvalues - 1.0));
  }
  return worst;
}

DirectionMap direction_map(const NamedAxes& axes, const TurningWall& shape, std::size_t directions,
                           Range searched, const MapOptions& options) {
  const SampledAxes device = axes.in_hand();
  check(shape.wall, device);
  (void)ticks_of_a_turn(shape, device.period_s);
  const SystemOfAxes system(device);
  DirectionMap map{.axes = axes, .shape = shape, .searched = searched, .boundaries = {}};
  map.boundaries.resize(directions);
  const auto is_stopped = [&] { return options.stop != nullptr && *options.stop; };
  const auto angle_of = [&](std::size_t i) {
    return std::numbers::pi * static_cast<double>(i) / static_cast<double>(directions);
  };
  const std::size_t different = shape.turns() ? 1 : directions;
  for_each_index(different, options.threads, [&](std::size_t i) {
    if (is_stopped()) return;
    map.boundaries[i] = boundary_at(axes, system, shape, angle_of(i), searched);
    if (options.done != nullptr) ++*options.done;
  });
  for (std::size_t i = different; i < directions; ++i) {
    map.boundaries[i] = map.boundaries.front();
    map.boundaries[i].angle_rad = angle_of(i);
    map.boundaries[i].one_axis = along_one_axis(axes, shape, angle_of(i), searched);
  }
  if (is_stopped())
    throw std::system_error(std::make_error_code(std::errc::interrupted), "the map is not complete");
  return map;
}

}  // namespace kerf::bench

#include "kerf/models/blade.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

namespace kerf::models {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The corners of a polygon in the tissue's frame that are under the plane, in order.
struct Submerged {
  std::array<Vector3d, BladeShape::max_corners + 1> corner;
  std::size_t corners = 0;

  void add(const Vector3d& point) noexcept { corner[corners++] = point; }
};

/// Cuts a convex polygon at z = 0. A convex polygon crosses the plane at most twice, so one corner more is
/// enough.
void clip(std::span<const Vector3d> polygon, Submerged& part) noexcept {
  part.corners = 0;
  std::size_t before = polygon.size() - 1;
  for (std::size_t i = 0; i < polygon.size(); before = i++) {
    const Vector3d& from = polygon[before];
    const Vector3d& to = polygon[i];
    if ((from.z() < 0.0) != (to.z() < 0.0) && part.corners < part.corner.size()) {
      part.add(from + from.z() / (from.z() - to.z()) * (to - from));
    }
    if (to.z() < 0.0 && part.corners < part.corner.size()) part.add(to);
  }
}

/// A force that acts at a point, taken to the hand point.
void add(Wrench& wrench, const Vector3d& force, const Vector3d& arm) noexcept {
  wrench.force += force;
  wrench.moment += arm.cross(force);
}

Vector3d surface_force(const BladeField& field, const Vector3d& normal, const Vector3d& v) noexcept {
  return -(field.tangential * v + (field.normal - field.tangential) * normal.dot(v) * normal);
}

/// Closed form over the submerged part: a fan of triangles from its first corner gives area, centroid and
/// moments.
void add_exact(Wrench& wrench, const Submerged& part, const Vector3d& n, const BladeField& field,
               const Pose& pose, const Twist& twist) noexcept {
  const Vector3d& origin = part.corner[0];
  double area = 0.0;
  Vector3d first = Vector3d::Zero();  // int r ds, r from the origin
  Matrix3d second = Matrix3d::Zero();
  Vector3d b = part.corner[1] - origin;
  for (std::size_t i = 2; i < part.corners; ++i) {
    const Vector3d c = part.corner[i] - origin;
    const double triangle = 0.5 * b.cross(c).dot(n);
    const Vector3d sum = b + c;
    area += triangle;
    first += triangle / 3.0 * sum;
    second.noalias() += triangle / 12.0 * (b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    b = c;
  }
  if (!(area > 0.0)) return;
  const Vector3d centroid = first / area;
  second.noalias() -= area * centroid * centroid.transpose();
  const Vector3d arm = origin + centroid - pose.hand;
  const Vector3d v = twist.linear + twist.angular.cross(arm);
  add(wrench, area * surface_force(field, n, v), arm);
  const Vector3d u = n.cross(twist.angular);
  wrench.moment -=
      field.tangential * n.dot(twist.angular) * second.trace() * n + field.normal * (second * u).cross(n);
}

/// Strips side by side along `across`, each with the force at the middle of its submerged length.
void add_strips(Wrench& wrench, std::span<const Vector3d> polygon, const Vector3d& across, const Vector3d& n,
                const BladeField& field, const BladeFidelity& fidelity, const Pose& pose,
                const Twist& twist) noexcept {
  const Vector3d along = n.cross(across);
  double least = across.dot(polygon[0]);
  double most = least;
  for (const Vector3d& corner : polygon) {
    least = std::min(least, across.dot(corner));
    most = std::max(most, across.dot(corner));
  }
  const double width = (most - least) / static_cast<double>(fidelity.strips);
  for (std::size_t strip = 0; strip < fidelity.strips; ++strip) {
    const double at = least + (static_cast<double>(strip) + 0.5) * width;
    // The middle line of the strip meets a convex polygon in one stretch, from one side to another.
    std::array<Vector3d, 2> end;
    std::size_t ends = 0;
    std::size_t before = polygon.size() - 1;
    for (std::size_t i = 0; i < polygon.size() && ends < 2; before = i++) {
      const double from = across.dot(polygon[before]) - at;
      const double to = across.dot(polygon[i]) - at;
      if ((from < 0.0) == (to < 0.0)) continue;
      end[ends++] = polygon[before] + from / (from - to) * (polygon[i] - polygon[before]);
    }
    if (ends < 2) continue;
    if (end[0].z() > end[1].z()) std::swap(end[0], end[1]);
    if (end[0].z() >= 0.0) continue;
    if (end[1].z() > 0.0) end[1] = end[0] + end[0].z() / (end[0].z() - end[1].z()) * (end[1] - end[0]);
    const double length = std::abs(along.dot(end[1] - end[0]));
    const Vector3d arm = 0.5 * (end[0] + end[1]) - pose.hand;
    const Vector3d v = fidelity.kind == BladeFidelity::Kind::paper
                           ? twist.linear
                           : Vector3d(twist.linear + twist.angular.cross(arm));
    add(wrench, width * length * surface_force(field, n, v), arm);
  }
}

void add_edge(Wrench& wrench, Vector3d from, Vector3d to, const BladeField& field,
              const BladeFidelity& fidelity, const Pose& pose, const Twist& twist) noexcept {
  if (from.z() > to.z()) std::swap(from, to);
  if (from.z() >= 0.0) return;
  if (to.z() > 0.0) to = from + from.z() / (from.z() - to.z()) * (to - from);
  const double length = (to - from).norm();
  if (!(length > 0.0)) return;
  const Vector3d arm = 0.5 * (from + to) - pose.hand;
  const bool paper = fidelity.kind == BladeFidelity::Kind::paper;
  const Vector3d v = paper ? twist.linear : Vector3d(twist.linear + twist.angular.cross(arm));
  add(wrench, -field.edge * length * v, arm);
  if (fidelity.kind != BladeFidelity::Kind::exact) return;
  const Vector3d t = (to - from) / length;
  wrench.moment -= field.edge * length * length * length / 12.0 * (twist.angular - t.dot(twist.angular) * t);
}

/// What an elastic field holds whose displacement has this wrench [J].
double energy_of(const Wrench& wrench, const Twist& displacement) noexcept {
  return std::max(0.0,
                  -0.5 * (wrench.force.dot(displacement.linear) + wrench.moment.dot(displacement.angular)));
}

Twist displacement_between(const Pose& from, const Pose& to) noexcept {
  return {.linear = to.hand - from.hand,
          .angular = rotation_vector_of(to.rotation * from.rotation.transpose())};
}

}  // namespace

Wrench blade_wrench(const BladeShape& shape, const BladeField& field, const BladeFidelity& fidelity,
                    const Pose& pose, const Twist& twist) noexcept {
  Wrench wrench;
  std::array<Vector3d, BladeShape::max_corners> corner;
  for (std::size_t p = 0; p < shape.polygons; ++p) {
    const BladeShape::Polygon& polygon = shape.polygon[p];
    bool any_under = false;
    for (std::size_t i = 0; i < polygon.corners; ++i) {
      corner[i] = pose.hand + pose.rotation * polygon.corner[i];
      any_under = any_under || corner[i].z() < 0.0;
    }
    if (!any_under) continue;
    const std::span<const Vector3d> corners(corner.data(), polygon.corners);
    const Vector3d n = pose.rotation * polygon.normal;
    if (fidelity.kind != BladeFidelity::Kind::exact) {
      add_strips(wrench, corners, pose.rotation * polygon.across, n, field, fidelity, pose, twist);
      continue;
    }
    Submerged part;
    clip(corners, part);
    if (part.corners >= 3) add_exact(wrench, part, n, field, pose, twist);
  }
  if (shape.has_edge) {
    add_edge(wrench, pose.hand + pose.rotation * shape.edge[0], pose.hand + pose.rotation * shape.edge[1],
             field, fidelity, pose, twist);
  }
  return wrench;
}

std::vector<LawAxis> Blade::axes() {
  return {{"x", "m", "N"},      {"y", "m", "N"},      {"z", "m", "N"},
          {"rx", "rad", "N·m"}, {"ry", "rad", "N·m"}, {"rz", "rad", "N·m"}};
}

std::vector<OptionInfo> Blade::options() {
  return {
      {"fidelity", std::string("exact"), "exact, strips or paper"},
      {"strips", 16.0, "strips a polygon, for strips and paper"},
      {"thresholds", true, "hold elastically up to F1 and again below F0; false: always cut"},
      {"form", std::string("passive"),
       "of the hold: passive, or paper (strains what was just submerged at no cost: creates energy)"},
      {"polygons", std::string("-0.005 0 -0.112, 0.005 0 -0.112, 0.005 0 -0.082, -0.005 0 -0.082"),
       "corners of the planar surfaces in the tool's frame, origin at the hand [m]"},
      {"edge", std::string("0.005 0 -0.112, 0.005 0 -0.082"), "ends of the cutting edge [m]; empty: none"}};
}

std::vector<ParameterInfo> Blade::parameters(const Options& given) {
  const OptionReader reader(name, options(), given);
  const auto at_least_zero = [](const char* what, Quantity quantity, const char* meaning) {
    return ParameterInfo{what, quantity, 0.0, 1e9, Scale::linear, meaning};
  };
  std::vector<ParameterInfo> all{
      at_least_zero("edge_damping", Quantity::edge_damping, "Kv, along the edge"),
      at_least_zero("normal_damping", Quantity::surface_damping, "Kn, of a surface moved along its normal"),
      at_least_zero("tangential_damping", Quantity::surface_damping, "Kt, of a surface moved in its plane")};
  if (reader.flag("thresholds")) {
    all.insert(
        all.end(),
        {at_least_zero("edge_stiffness", Quantity::edge_stiffness, "of the tissue at the edge"),
         at_least_zero("normal_stiffness", Quantity::surface_stiffness, "at a surface, along its normal"),
         at_least_zero("tangential_stiffness", Quantity::surface_stiffness, "at a surface, in its plane"),
         at_least_zero("release_force", Quantity::load, "F0, the tissue holds again below it"),
         at_least_zero("rupture_force", Quantity::load, "F1, it gives way above it")});
  }
  return all;
}

Blade Blade::make(std::span<const double> values, const Options& given) {
  const OptionReader reader(name, options(), given);
  Blade law;
  law.viscous = {values[0], values[1], values[2]};
  law.has_thresholds = reader.flag("thresholds");
  if (law.has_thresholds) {
    law.elastic = {values[3], values[4], values[5]};
    law.thresholds = {values[6], values[7]};
    if (!(values[6] < values[7])) {
      throw std::invalid_argument("law 'blade': release_force must be smaller than rupture_force");
    }
  }
  law.paper = reader.choice("form", {"passive", "paper"}) == "paper";
  const std::string fidelity = reader.choice("fidelity", {"exact", "strips", "paper"});
  law.fidelity.kind = fidelity == "exact"    ? BladeFidelity::Kind::exact
                      : fidelity == "strips" ? BladeFidelity::Kind::strips
                                             : BladeFidelity::Kind::paper;
  law.fidelity.strips = reader.count("strips", 1, 256);
  law.shape = BladeShape::parse(reader.text("polygons"), reader.text("edge"));
  return law;
}

Twist Blade::carried_strain(const State& state, const Pose& pose) const noexcept {
  Twist strain{.linear = pose.rotation * state.strain.linear,
               .angular = pose.rotation * state.strain.angular};
  const double carried_j = energy_of(blade_wrench(shape, elastic, fidelity, pose, strain), strain);
  if (carried_j > state.stored_j) {
    strain.linear *= state.stored_j / carried_j;
    strain.angular *= state.stored_j / carried_j;
  }
  return strain;
}

Wrench Blade::hold(State& state, const Pose& pose) const noexcept {
  Twist strain = displacement_between(state.anchor, pose);
  if (!paper) {
    const Twist carried = carried_strain(state, pose);
    strain.linear += carried.linear;
    strain.angular += carried.angular;
    state.anchor = pose;
    state.strain = {.linear = pose.rotation.transpose() * strain.linear,
                    .angular = pose.rotation.transpose() * strain.angular};
  }
  const Wrench wrench = blade_wrench(shape, elastic, fidelity, pose, strain);
  state.stored_j = energy_of(wrench, strain);
  return wrench;
}

void Blade::begin_to_hold(State& state, const Pose& pose) noexcept {
  state.anchor = pose;
  state.strain = {};
  state.stored_j = 0.0;
}

Wrench Blade::step(State& state, const Pose& pose, const Twist& twist) const noexcept {
  if (!has_thresholds) return blade_wrench(shape, viscous, fidelity, pose, twist);
  if (!state.in_tissue) begin_to_hold(state, pose);
  const bool cut = state.mode.cutting;
  const Wrench wrench = cut ? blade_wrench(shape, viscous, fidelity, pose, twist) : hold(state, pose);
  // The field is zero out of the tissue, and its anchor then follows the blade.
  state.in_tissue = touches(pose);
  if (!state.in_tissue) {
    state.mode.cutting = false;
    state.stored_j = 0.0;
    return {};
  }
  if (thresholds.step(state.mode, wrench.force.norm()) == cut) return wrench;
  begin_to_hold(state, pose);
  return state.mode.cutting ? blade_wrench(shape, viscous, fidelity, pose, twist) : Wrench{};
}

bool Blade::touches(const Pose& pose) const noexcept {
  const auto under = [&](const Vector3d& point) {
    return pose.hand.z() + pose.rotation.row(2).dot(point) < 0.0;
  };
  for (std::size_t p = 0; p < shape.polygons; ++p) {
    for (std::size_t i = 0; i < shape.polygon[p].corners; ++i) {
      if (under(shape.polygon[p].corner[i])) return true;
    }
  }
  return shape.has_edge && (under(shape.edge[0]) || under(shape.edge[1]));
}

AxisValues Blade::step(State& state, const SpatialMotion& motion, double) const noexcept {
  const Vector3d turn(motion.position[3], motion.position[4], motion.position[5]);
  const Matrix3d jacobian = left_jacobian(turn);
  const Pose pose{.hand = {motion.position[0], motion.position[1], motion.position[2]},
                  .rotation = rotation_of(turn)};
  const Twist twist{
      .linear = {motion.velocity[0], motion.velocity[1], motion.velocity[2]},
      .angular = jacobian * Vector3d(motion.velocity[3], motion.velocity[4], motion.velocity[5])};
  const Wrench wrench = step(state, pose, twist);
  const Vector3d torque = jacobian.transpose() * wrench.moment;
  return {wrench.force.x(), wrench.force.y(), wrench.force.z(), torque.x(), torque.y(), torque.z()};
}

}  // namespace kerf::models

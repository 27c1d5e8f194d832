#include "import/spatial/spatial_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/core.h>

#include <kerf/models/rotation.h>

#include "poses/turns.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::size_t not_mapped = std::numeric_limits<std::size_t>::max();
constexpr double near_whole_turn_rad = 0.2;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// The places among the mapped columns of "position.x", "position.y", "position.z", or of an orientation's
/// numbers.
std::vector<std::size_t> places_of(const std::vector<MappedColumn>& columns,
                                   const std::vector<std::string>& channels) {
  std::vector<std::size_t> places;
  for (const std::string& channel : channels) {
    const auto found = std::ranges::find(columns, channel, &MappedColumn::channel);
    places.push_back(found == columns.end() ? not_mapped : static_cast<std::size_t>(found - columns.begin()));
  }
  return places;
}

std::vector<std::size_t> places_of_vector(const std::vector<MappedColumn>& columns, const std::string& name) {
  return places_of(columns, {name + ".x", name + ".y", name + ".z"});
}

/// Reads orientations out of the columns.
class Turns {
 public:
  Turns(const OrientationForm& form, const std::vector<MappedColumn>& columns, const MappedValues& values)
      : form_(form), values_(values) {
    std::vector<std::string> channels;
    for (std::size_t i = 1; i <= form.columns(); ++i) channels.push_back(fmt::format("orientation.{}", i));
    places_ = places_of(columns, channels);
  }
  [[nodiscard]] std::size_t first_place() const { return places_.front(); }
  [[nodiscard]] std::size_t last_place() const { return places_.back(); }
  [[nodiscard]] std::string fault(std::size_t row) { return fault_of(form_, numbers(row)); }
  [[nodiscard]] Quaterniond operator[](std::size_t row) { return turn_of(form_, numbers(row)); }

 private:
  std::span<const double> numbers(std::size_t row) {
    for (std::size_t i = 0; i < places_.size(); ++i) numbers_.at(i) = values_[places_[i]][row];
    return {numbers_.data(), places_.size()};
  }

  const OrientationForm& form_;
  const MappedValues& values_;
  std::vector<std::size_t> places_;
  std::array<double, 9> numbers_{};
};

Vector3d vector_at(const MappedValues& values, const std::vector<std::size_t>& places, std::size_t row) {
  if (places.front() == not_mapped) return Vector3d::Constant(no_number);
  return {values[places[0]][row], values[places[1]][row], values[places[2]][row]};
}

struct Wrench {
  Vector3d force;
  Vector3d torque;
};

/// In the world's axes, with the torque about the position p.
Wrench at_position(const Wrench& given, const SpatialMap& map, const SpatialPlaces& places, const Vector3d& p,
                   const Matrix3d& to_world) {
  const bool in_sensor = map.frame == "sensor";
  Vector3d lever = Vector3d::Zero();
  if (places.point_m) lever = Vector3d(places.point_m->data()) - (in_sensor ? Vector3d::Zero().eval() : p);
  const Vector3d torque = given.torque + lever.cross(given.force);
  if (!in_sensor) return {.force = given.force, .torque = torque};
  return {.force = to_world * given.force, .torque = to_world * torque};
}

bool is_near_whole_turn(const Vector3d& r) {
  constexpr double whole = 2.0 * std::numbers::pi;
  const double turns = r.norm() / whole;
  return turns > 0.5 && std::abs(turns - std::round(turns)) * whole < near_whole_turn_rad;
}

void append_vector(std::vector<double>& row, const Vector3d& v) { row.insert(row.end(), v.begin(), v.end()); }

std::string rotation_text(const std::array<double, 3>& v) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g}) rad", v[0], v[1], v[2]);
}

void name_axes(schema::Recording& recording, bool turns) {
  recording.axes.clear();
  for (const char* name : {"x", "y", "z"}) recording.axes.push_back({.name = name});
  if (!turns) return;
  for (const char* name : {"rx", "ry", "rz"})
    recording.axes.push_back({.name = name, .position_unit = "rad", .force_unit = "N·m"});
}

}  // namespace

void require_rotations(const SpatialMap& map, const std::vector<MappedColumn>& columns,
                       const MappedValues& values, const std::string& name,
                       const std::function<std::size_t(std::size_t)>& line_of_row) {
  if (!map.orientation) return;
  Turns turns(*map.orientation, columns, values);
  for (std::size_t row = 0; row < values.front().size(); ++row) {
    const std::string fault = turns.fault(row);
    if (fault.empty()) continue;
    throw std::invalid_argument(fmt::format("{}:{}: columns {} to {} {}; nan where there is none", name,
                                            line_of_row(row), columns[turns.first_place()].index + 1,
                                            columns[turns.last_place()].index + 1, fault));
  }
}

std::vector<std::string> take_spatial_axes(schema::Recording& recording, const SpatialMap& map,
                                           const std::vector<MappedColumn>& columns,
                                           const MappedValues& values, const SpatialPlaces& places) {
  const auto positions = places_of_vector(columns, "position");
  const auto forces = places_of_vector(columns, "force");
  const auto torques = places_of_vector(columns, "torque");
  const Vector3d origin(places.origin_m.data());
  std::optional<Turns> turns;
  if (map.orientation) turns.emplace(*map.orientation, columns, values);
  name_axes(recording, turns.has_value());
  const std::size_t rows = values[positions.front()].size();
  recording.position.reserve(rows * recording.dimensions());
  if (map.has_force) recording.force_measured.reserve(rows * recording.dimensions());

  Matrix3d to_tool = Matrix3d::Identity();
  if (places.sensor_rotation_rad) {
    const Vector3d s(places.sensor_rotation_rad->data());
    to_tool = Eigen::AngleAxisd(s.norm(), s.stableNormalized()).toRotationMatrix();
  }
  RotationPath path;
  std::size_t near_whole_turn = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const Vector3d p = vector_at(values, positions, row);
    append_vector(recording.position, p - origin);
    Matrix3d to_world = Matrix3d::Identity();
    Vector3d r = Vector3d::Zero();
    if (turns) {
      const Quaterniond turn = (*turns)[row];
      to_world = turn.toRotationMatrix();
      r = path.next(turn);
      append_vector(recording.position, r);
      near_whole_turn += is_near_whole_turn(r) ? 1U : 0U;
    }
    if (!map.has_force) continue;
    const Wrench wrench = at_position({.force = to_tool * vector_at(values, forces, row),
                                       .torque = to_tool * vector_at(values, torques, row)},
                                      map, places, p, to_world);
    append_vector(recording.force_measured, wrench.force);
    if (turns) append_vector(recording.force_measured, models::left_jacobian(r).transpose() * wrench.torque);
  }
  if (map.has_force) {
    recording.header.device_properties["wrench_frame"] = map.frame;
    if (places.sensor_rotation_rad)
      recording.header.device_properties["sensor_rotation"] = rotation_text(*places.sensor_rotation_rad);
    if (turns) recording.header.device_properties["torques"] = "generalised";
  }
  if (near_whole_turn == 0) return {};
  return {fmt::format(
      "in {} rows the rotation is within {:g} rad of a whole turn, where rotation vector, its rates and "
      "torques along rx, ry, rz tell little",
      near_whole_turn, near_whole_turn_rad)};
}

std::string spatial_text(const SpatialMap& map, const SpatialPlaces& places) {
  const auto text_of = [](const std::array<double, 3>& v) {
    return fmt::format("({:g}, {:g}, {:g}) m", v[0], v[1], v[2]);
  };
  std::string text = map.orientation ? "six axes, orientation by " + map.orientation->text() : "three axes";
  if (map.has_force) {
    text += fmt::format(", {} in the frame {} turned to the world's", map.has_torque ? "wrench" : "force",
                        map.frame);
  }
  if (places.sensor_rotation_rad) text += ", sensor turned by " + rotation_text(*places.sensor_rotation_rad);
  if (places.point_m) text += fmt::format(", torques about {}", text_of(*places.point_m));
  if (places.origin_m != std::array<double, 3>{})
    text += fmt::format(", origin {}", text_of(places.origin_m));
  return text;
}

void derive_velocities(schema::Recording& recording, double window_s) {
  const std::size_t dimensions = recording.dimensions();
  recording.velocity.resize(recording.position.size());
  std::vector<double> along(recording.rows());
  for (std::size_t axis = 0; axis < dimensions; ++axis) {
    for (std::size_t row = 0; row < along.size(); ++row)
      along[row] = recording.position[row * dimensions + axis];
    const std::vector<double> slopes = differentiate(recording.time, along, window_s);
    for (std::size_t row = 0; row < along.size(); ++row)
      recording.velocity[row * dimensions + axis] = slopes[row];
  }
}

}  // namespace kerf::bench

#include "stability/several/several_device.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/core.h>
#include <toml++/toml.h>

#include <kerf/drivers/simulated_premium.h>
#include <kerf/drivers/velocity_filter.h>
#include <kerf/mechanisms/premium.h>

#include "files/named_file.h"
#include "laws/law_toml.h"
#include "stability/device/in_hand.h"

namespace kerf::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using mechanisms::Premium;

MatrixXd read_matrix(const Place& place, const toml::table& table, std::string_view key, Index axes,
                     const MatrixXd& standard) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return standard;
  const auto refuse = [&](const toml::node& at) {
    place.refuse(at, "'{}' is no {} by {} matrix, expected {} rows of {} numbers: [[1, 0], [0, 1]]", key,
                 axes, axes, axes, axes);
  };
  const toml::array* rows = node->as_array();
  if (rows == nullptr || static_cast<Index>(rows->size()) != axes) refuse(*node);
  MatrixXd matrix(axes, axes);
  for (Index row = 0; row < axes; ++row) {
    const toml::node& line = (*rows)[static_cast<std::size_t>(row)];
    const toml::array* numbers = line.as_array();
    if (numbers == nullptr || static_cast<Index>(numbers->size()) != axes) refuse(line);
    for (Index column = 0; column < axes; ++column)
      matrix(row, column) = place.number((*numbers)[static_cast<std::size_t>(column)], key);
  }
  return matrix;
}

std::vector<std::string> read_names(const Place& place, const toml::table& table, std::string_view key,
                                    std::size_t least, std::size_t most) {
  const toml::node* node = table.get(key);
  std::vector<std::string> names;
  if (node != nullptr && node->is_array()) {
    for (const toml::node& name : *node->as_array()) {
      if (name.is_string()) names.push_back(name.as_string()->get());
    }
  }
  if (node == nullptr || names.size() < least || names.size() > most ||
      names.size() != node->as_array()->size()) {
    place.refuse(node != nullptr ? *node : static_cast<const toml::node&>(table),
                 "'{}': expected {} to {} names: [\"x\", \"y\"]", key, least, most);
  }
  return names;
}

Index axis_named(const Place& place, const toml::node& at, const std::vector<std::string>& names,
                 const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) place.refuse(at, "'plane' has '{}', which is none of the axes", name);
  return found - names.begin();
}

const toml::table& table_or_none(const Place& place, const toml::table& root, std::string_view key) {
  static const toml::table none;
  return root.contains(key) ? place.table(root, key) : none;
}

SeveralAxes from_file(const std::string& file) {
  const Place place(file);
  const toml::table root = parse_toml(read_named_file(file), file);
  place.allow_only(root, {"axes", "mass_kg", "viscous_n_s_per_m", "wall", "tool"}, "a file of several axes");
  SeveralAxes read{.of = file, .axes = {}, .shape = {}};
  read.axes.names = read_names(place, root, "axes", 1, static_cast<std::size_t>(SampledAxes::max_axes));
  const auto n = static_cast<Index>(read.axes.names.size());
  for (const std::string_view key : {"mass_kg", "viscous_n_s_per_m"}) {
    if (!root.contains(key)) place.refuse(root, "'{}' is missing: a matrix of {} rows", key, n);
  }
  read.axes.device.mass = read_matrix(place, root, "mass_kg", n, {});
  read.axes.device.damping = read_matrix(place, root, "viscous_n_s_per_m", n, {});
  const toml::table& wall = table_or_none(place, root, "wall");
  place.allow_only(wall, {"stiffness", "damping_n_s_per_m", "plane"}, "[wall]");
  read.shape.wall.stiffness = read_matrix(place, wall, "stiffness", n, MatrixXd::Identity(n, n));
  const double largest = read.shape.wall.stiffness.cwiseAbs().maxCoeff();
  if (!(largest > 0.0))
    place.refuse(*wall.get("stiffness"), "'stiffness' is zero, and its multiples are sought");
  read.shape.wall.stiffness /= largest;
  read.shape.wall.damping = read_matrix(place, wall, "damping_n_s_per_m", n, MatrixXd::Zero(n, n));
  if (n > 1) {
    const std::vector<std::string> plane = wall.contains("plane")
                                               ? read_names(place, wall, "plane", 2, 2)
                                               : std::vector{read.axes.names[0], read.axes.names[1]};
    const toml::node& at = wall.contains("plane") ? *wall.get("plane") : static_cast<const toml::node&>(wall);
    read.shape.first_axis = axis_named(place, at, read.axes.names, plane[0]);
    read.shape.second_axis = axis_named(place, at, read.axes.names, plane[1]);
    if (plane[0] == plane[1]) place.refuse(at, "'plane' has '{}' twice", plane[0]);
  }
  const toml::table& tool = table_or_none(place, root, "tool");
  place.allow_only(tool, {"rotation_rad_s", "drags"}, "[tool]");
  if (const toml::node* rate = tool.get("rotation_rad_s"))
    read.shape.rate_rad_s = place.number(*rate, "rotation_rad_s");
  read.shape.drags = place.flag(tool, "drags", false);
  return read;
}

/// The tip of a Premium at joint angles q1, q2, q3.
void take_premium(const WayRequest& way, NamedAxes& axes) {
  const std::vector<double> given =
      axis_values({"q1", "q2", "q3"}, way.from, {.option = "--from", .whose = "sim:premium"});
  const Premium::Vector q(given[0], given[1], given[2]);
  if (!Premium::within_limits(q)) {
    throw std::invalid_argument(
        fmt::format("--from: q1={}, q2={}, q3={} rad is beyond the joints' stops", q[0], q[1], q[2]));
  }
  axes.names = {"x", "y", "z"};
  const Premium::Matrix back = Premium::jacobian(q).inverse();
  axes.device.mass = back.transpose() * Premium().inertia(q) * back;
  axes.device.damping = drivers::SimulatedPremium::viscous_n_m_s * back.transpose() * back;
}

void take_independent(const drivers::DeviceInfo& info, NamedAxes& axes) {
  std::vector<drivers::Mechanics> known;
  for (const drivers::AxisInfo& axis : info.axes) {
    if (axis.force_unit != "N") continue;  // an angle with a torque has no part in a direction
    if (!axis.mechanics) {
      throw std::invalid_argument(
          fmt::format("{}: mass and friction of axis '{}' are not known; give them by --several FILE.toml",
                      info.uri, axis.name));
    }
    axes.names.push_back(axis.name);
    known.push_back(*axis.mechanics);
  }
  if (known.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: none of its axes is moved by a force; give --several FILE.toml with a mass matrix", info.uri));
  }
  const auto n = static_cast<Index>(known.size());
  axes.device.mass = axes.device.damping = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    axes.device.mass(i, i) = known[static_cast<std::size_t>(i)].mass_kg;
    axes.device.damping(i, i) = known[static_cast<std::size_t>(i)].viscous_n_s_per_m;
  }
}

SeveralAxes from_device(const SeveralRequest& request, const AxisRequest& on) {
  SeveralAxes taken{.of = request.of, .axes = {}, .shape = {}};
  const drivers::DeviceInfo info = drivers::open_device(request.of)->info();
  if (info.model == "sim:premium") {
    take_premium(on.way, taken.axes);
  } else {
    take_independent(info, taken.axes);
  }
  const Index n = taken.axes.device.axes();
  taken.shape.wall.stiffness = request.across * MatrixXd::Identity(n, n);
  taken.shape.wall.stiffness(0, 0) = 1.0;
  taken.shape.wall.damping = request.wall_damping * MatrixXd::Identity(n, n);
  taken.shape.rate_rad_s = request.rotation_rad_s;
  taken.shape.drags = request.drags;
  taken.axes.device.velocity_corner_rad_s = drivers::VelocityFilter::corner_rad_s;
  return taken;
}

}  // namespace

SeveralAxes several_axes(const SeveralRequest& request, const AxisRequest& on) {
  const bool is_file = request.of.find(':') == std::string::npos || request.of.ends_with(".toml");
  SeveralAxes several = is_file ? from_file(request.of) : from_device(request, on);
  SampledAxes& device = several.axes.device;
  const Index n = device.axes();
  device.period_s = 1.0 / on.rate_hz;
  device.delay_s = on.delay_s.value_or(device.delay_s);
  device.velocity_corner_rad_s = on.velocity_corner_rad_s.value_or(device.velocity_corner_rad_s);
  const HandImpedance hand = requested_hand(on);
  several.axes.hand_mass = hand.mass_kg * MatrixXd::Identity(n, n);
  several.axes.hand_damping = hand.damping_n_s_per_m * MatrixXd::Identity(n, n);
  several.axes.hand_stiffness = hand.stiffness_n_per_m * MatrixXd::Identity(n, n);
  check(several.axes.in_hand());
  check(several.shape.wall, device);
  return several;
}

}  // namespace kerf::bench

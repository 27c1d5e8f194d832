#include "blade/blade_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

using Eigen::Vector3d;

constexpr std::size_t fewest_rows = 10;

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument("law 'blade': " + why); }

void check_finite(std::span<const double> values, const char* what, const std::array<double, 6>& noise) {
  static constexpr std::array names{"x", "y", "z", "rx", "ry", "rz"};
  const bool is_force = std::string_view(what) == "force";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) || (is_force && std::isinf(noise[i % 6]))) continue;
    refuse(std::string("the ") + what + " along '" + names[i % 6] + "' of sample " + std::to_string(i / 6) +
           " is not finite");
  }
}

void check(const BladeSeries& series, const BladeFitOptions& options) {
  const std::size_t count = series.time_s.size();
  if (series.position.size() != 6 * count || series.velocity.size() != 6 * count ||
      series.force.size() != 6 * count) {
    refuse("time, position, velocity and force of the series differ in length");
  }
  if (count < fewest_rows) {
    refuse("only " + std::to_string(count) + " samples, expected " + std::to_string(fewest_rows) +
           " at least");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(series.time_s[i]))
      refuse("the time of sample " + std::to_string(i) + " is not finite");
    if (i > 0 && !(series.time_s[i] > series.time_s[i - 1])) {
      refuse("the time does not increase at sample " + std::to_string(i));
    }
  }
  for (const double deviation : options.noise) {
    if (!(deviation >= 0.0)) refuse("the noise of an axis must not be negative");
  }
  if (std::all_of(options.noise.begin(), options.noise.end(), [](double d) { return std::isinf(d); })) {
    refuse("every axis is left out; at least one has to measure a force");
  }
  if (!(options.confidence > 0.0 && options.confidence < 1.0))
    refuse("the confidence must be between 0 and 1");
  if (!(options.peaks.window_s > 0.0)) refuse("the window of the peaks must be greater than zero");
  if (!(options.peaks.prominence > 0.0)) refuse("the prominence of the peaks must be greater than zero");
  check_finite(series.position, "position", options.noise);
  check_finite(series.velocity, "velocity", options.noise);
  check_finite(series.force, "force", options.noise);
}

Vector3d three(std::span<const double> values, std::size_t at) {
  return {values[at], values[at + 1], values[at + 2]};
}

double median_step(std::span<const double> time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return median_of(std::move(steps));
}

}  // namespace

BladeRows rows_of(const BladeSeries& series, const BladeFitOptions& options) {
  check(series, options);
  models::Options law_options = options.law_options;
  law_options["thresholds"] = false;
  const models::Blade law = models::Blade::make(std::array{0.0, 0.0, 0.0}, law_options);
  BladeRows rows{.shape = law.shape, .fidelity = law.fidelity};
  rows.time_s.assign(series.time_s.begin(), series.time_s.end());
  rows.period_s = median_step(series.time_s);
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    const Vector3d turn = three(series.position, 6 * i + 3);
    rows.jacobian.push_back(models::left_jacobian(turn));
    rows.pose.push_back({.hand = three(series.position, 6 * i), .rotation = models::rotation_of(turn)});
    rows.twist.push_back({.linear = three(series.velocity, 6 * i),
                          .angular = rows.jacobian.back() * three(series.velocity, 6 * i + 3)});
    Vector6d force = Eigen::Map<const Vector6d>(series.force.data() + 6 * i);
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      if (std::isinf(options.noise[static_cast<std::size_t>(axis)])) force[axis] = 0.0;
    }
    rows.force.push_back(force);
    rows.in_tissue.push_back(law.touches(rows.pose.back()));
  }
  const auto touching = std::count(rows.in_tissue.begin(), rows.in_tissue.end(), true);
  if (touching < static_cast<std::ptrdiff_t>(fewest_rows)) {
    refuse("the blade is in the tissue (a corner or an end of its edge under z = 0) in only " +
           std::to_string(touching) + " of " + std::to_string(rows.size()) +
           " samples; check polygons, edge and the frame of the positions");
  }
  return rows;
}

Vector6d force_of(const BladeRows& rows, std::size_t row, const models::BladeField& field,
                  const models::Twist& twist) {
  const models::Wrench wrench = models::blade_wrench(rows.shape, field, rows.fidelity, rows.pose[row], twist);
  Vector6d force;
  force << wrench.force, rows.jacobian[row].transpose() * wrench.moment;
  return force;
}

Columns columns_of(const BladeRows& rows, std::size_t row, const models::Twist& twist) {
  Columns columns;
  columns.col(0) = force_of(rows, row, {1.0, 0.0, 0.0}, twist);
  columns.col(1) = force_of(rows, row, {0.0, 1.0, 0.0}, twist);
  columns.col(2) = force_of(rows, row, {0.0, 0.0, 1.0}, twist);
  return columns;
}

models::Twist displacement_of(const models::Pose& pose, const models::Pose& anchor) {
  return {.linear = pose.hand - anchor.hand,
          .angular = models::rotation_vector_of(pose.rotation * anchor.rotation.transpose())};
}

}  // namespace kerf::fitting

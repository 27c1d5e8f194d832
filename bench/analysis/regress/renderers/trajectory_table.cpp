#include "regress/renderers/trajectory_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <fmt/ranges.h>

#include "files/named_file.h"
#include "regress/renderers/number_table.h"

namespace kerf::bench {
namespace {

constexpr std::array<std::string_view, 3> turns{"rx", "ry", "rz"};
constexpr std::string_view parts = "wxyz";   ///< of a quaternion as it is computed
constexpr double largest_turn_apart = 1e-6;  ///< sine of half the angle between two turns that are one

using Quaternion = std::array<double, 4>;  ///< w, x, y, z

std::array<std::size_t, 3> turn_axes(const std::vector<models::LawAxis>& axes) {
  std::array<std::size_t, 3> found{};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    found[i] =
        static_cast<std::size_t>(std::ranges::find(axes, turns[i], &models::LawAxis::name) - axes.begin());
  }
  return found;
}

/// (cos(a/2), sin(a/2) r/a) of a rotation vector r of length a.
Quaternion quaternion_of(const models::SpatialMotion& sample, const std::array<std::size_t, 3>& axes) {
  const double x = sample.position[axes[0]];
  const double y = sample.position[axes[1]];
  const double z = sample.position[axes[2]];
  const double angle = std::hypot(x, y, z);
  const double share = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
  return {std::cos(0.5 * angle), share * x, share * y, share * z};
}

/// Holds a quaternion that stands in a table against the rotation vector beside it.
void require_same_turn(const std::filesystem::path& file, const NumberTable& table, std::size_t row,
                       const models::SpatialMotion& sample, const std::array<std::size_t, 3>& axes) {
  const Quaternion expected = quaternion_of(sample, axes);
  double along = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t column = table.column(fmt::format("q{}[1]", parts[i]));
    if (column == table.names.size()) return;
    along += expected[i] * table.at(row, column);
    square += table.at(row, column) * table.at(row, column);
  }
  if (std::abs(square - 1.0) < 1e-6 && 1.0 - along * along < largest_turn_apart * largest_turn_apart * 4.0)
    return;
  throw std::invalid_argument(fmt::format(
      "{}: the quaternion of row {} is another turn than rx, ry, rz beside it; expected (cos(a/2), sin(a/2) "
      "r/a) under qw[1], qx[1], qy[1], qz[1]",
      file.string(), row));
}

}  // namespace

bool turn_in_space(const std::vector<models::LawAxis>& axes) {
  return std::ranges::all_of(turn_axes(axes), [&](std::size_t axis) {
    return axis < axes.size() && axes[axis].position_unit == "rad";
  });
}

std::vector<std::string> TrajectoryColumns::names() const {
  std::vector<std::string> all{"tick", "time[s]"};
  for (const models::LawAxis& axis : axes) {
    all.push_back(fmt::format("{}[{}]", axis.name, axis.position_unit));
    all.push_back(fmt::format("v{}[{}/s]", axis.name, axis.position_unit));
  }
  for (const char part : quaternion) all.push_back(fmt::format("q{}[1]", part));
  all.emplace_back("period[s]");
  return all;
}

void TrajectoryColumns::append_row(std::string& text, const SampledMotion& motion, std::size_t tick) const {
  const auto out = std::back_inserter(text);
  const models::SpatialMotion& sample = motion.sample[tick];
  fmt::format_to(out, "{},{}", tick, motion.time_s[tick]);
  for (std::size_t i = 0; i < axes.size(); ++i)
    fmt::format_to(out, ",{},{}", sample.position[i], sample.velocity[i]);
  for (const char part : quaternion) fmt::format_to(out, ",{}", turn(sample, part));
  fmt::format_to(out, ",{}", motion.period_s[tick]);
}

double TrajectoryColumns::turn(const models::SpatialMotion& sample, char part) const {
  return quaternion_of(sample, turn_axes(axes))[parts.find(part)];
}

std::string trajectory_csv(const SampledMotion& motion, const TrajectoryColumns& columns) {
  std::string text = fmt::format("{}\n", fmt::join(columns.names(), ","));
  for (std::size_t tick = 0; tick < motion.ticks(); ++tick) {
    columns.append_row(text, motion, tick);
    text += '\n';
  }
  return text;
}

SampledMotion read_trajectory_csv(const std::filesystem::path& file,
                                  const std::vector<models::LawAxis>& axes) {
  return motion_of(read_number_table(file, LargestInput::table), axes, file);
}

SampledMotion motion_of(const NumberTable& table, const std::vector<models::LawAxis>& axes,
                        const std::filesystem::path& file) {
  const auto column = [&](const std::string& name) {
    const std::size_t found = table.column(name);
    if (found < table.names.size()) return found;
    throw std::invalid_argument(fmt::format("{}: found the columns {}, expected also {}", file.string(),
                                            fmt::join(table.names, ","), name));
  };
  SampledMotion motion;
  const std::size_t time = column("time[s]");
  const bool in_space = turn_in_space(axes);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    models::SpatialMotion sample;
    motion.time_s.push_back(table.at(row, time));
    bool sound =
        std::isfinite(motion.time_s.back()) && (row == 0 || motion.time_s[row] > motion.time_s[row - 1]);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto& [name, unit, force] = axes[i];
      sample.position[i] = table.at(row, column(fmt::format("{}[{}]", name, unit)));
      sample.velocity[i] = table.at(row, column(fmt::format("v{}[{}/s]", name, unit)));
      sound = sound && std::isfinite(sample.position[i]) && std::isfinite(sample.velocity[i]);
    }
    if (!sound)
      throw std::invalid_argument(
          fmt::format("{}: row {} is not finite, or its time does not grow", file.string(), row));
    if (in_space) require_same_turn(file, table, row, sample, turn_axes(axes));
    motion.sample.push_back(sample);
  }
  motion.period_s = periods_of(motion.time_s);
  const std::size_t period = table.column("period[s]");
  for (std::size_t row = 0; row < table.rows() && period < table.names.size(); ++row) {
    motion.period_s[row] = table.at(row, period);
    if (motion.period_s[row] > 0.0 && std::isfinite(motion.period_s[row])) continue;
    throw std::invalid_argument(fmt::format("{}: the period of row {} is no time", file.string(), row));
  }
  return motion;
}

}  // namespace kerf::bench

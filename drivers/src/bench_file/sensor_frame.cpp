#include "kerf/drivers/sensor_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kerf/drivers/toml_text.h"

namespace kerf::drivers {
namespace {

using FrameVector = SensorFrame::Vector;

constexpr double rotation_tolerance = 1e-3;

/// A product that does not ask for what it does not depend on: 0 of what is not known is 0.
double share_of(double of, double value) noexcept { return of == 0.0 ? 0.0 : of * value; }

double sum_of_shares(const FrameVector& of, const FrameVector& values) noexcept {
  return share_of(of[0], values[0]) + share_of(of[1], values[1]) + share_of(of[2], values[2]);
}

double frame_dot(const FrameVector& a, const FrameVector& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double frame_determinant(const std::array<FrameVector, 3>& rows) noexcept {
  const auto& [a, b, c] = rows;
  return frame_dot(a, {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]});
}

std::string vector_text(const FrameVector& of) {
  return fmt::format("[{}, {}, {}]", toml_number(of[0]), toml_number(of[1]), toml_number(of[2]));
}

}  // namespace

Axes SensorFrame::apply(const Axes& wrench) const noexcept {
  const FrameVector force{wrench[0], wrench[1], wrench[2]};
  const auto& r = tool_m;
  const FrameVector torque{wrench[3] - (share_of(r[1], force[2]) - share_of(r[2], force[1])),
                           wrench[4] - (share_of(r[2], force[0]) - share_of(r[0], force[2])),
                           wrench[5] - (share_of(r[0], force[1]) - share_of(r[1], force[0]))};
  Axes turned{};
  for (std::size_t i = 0; i < 3; ++i) {
    turned[i] = sum_of_shares(rotation[i], force);
    turned[i + 3] = sum_of_shares(rotation[i], torque);
  }
  return turned;
}

std::string no_rotation(const std::array<FrameVector, 3>& rows) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = std::sqrt(frame_dot(rows[i], rows[i]));
    if (!(std::abs(length - 1.0) < rotation_tolerance))
      return fmt::format("row {} has the length {:.4g} and not 1", i + 1, length);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t other = (i + 1) % 3;
    const double cosine = frame_dot(rows[i], rows[other]);
    if (std::abs(cosine) < rotation_tolerance) continue;
    constexpr double degrees = 180.0 / std::numbers::pi;
    return fmt::format("rows {} and {} are {:.4g} degrees apart and not 90", std::min(i, other) + 1,
                       std::max(i, other) + 1, degrees * std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  return frame_determinant(rows) > 0.0 ? "" : "it mirrors (its determinant is -1): a row has the wrong sign";
}

std::string no_frame_for(const std::vector<AxisInfo>& axes) {
  constexpr std::array names{"x", "y", "z", "rx", "ry", "rz"};
  bool fits = axes.size() == 3 || axes.size() == max_axes;
  std::vector<std::string> told;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    fits = fits && i < names.size() && axes[i].name == names.at(i) &&
           axes[i].force_unit == (i < 3 ? "N" : "N·m");
    told.push_back(fmt::format("{} [{}]", axes[i].name, axes[i].force_unit));
  }
  if (fits) return {};
  return fmt::format(
      "it tells {}, and what is turned by a frame is x, y, z [N] with or without rx, ry, rz [N·m]",
      fmt::join(told, ", "));
}

std::string to_toml(const SensorFrame& frame) {
  return fmt::format("{{ rotation = [{}, {}, {}], tool = {} }} # tool in m", vector_text(frame.rotation[0]),
                     vector_text(frame.rotation[1]), vector_text(frame.rotation[2]),
                     vector_text(frame.tool_m));
}

}  // namespace kerf::drivers

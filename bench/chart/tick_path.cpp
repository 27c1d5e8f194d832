#include "chart/tick_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "laws/placement.h"

namespace kerf::bench {
namespace {

constexpr double stroke_s = 1.0;
constexpr double pause_s = 0.5;
constexpr double strokes = 4.0;     // there and back, twice
constexpr double free_share = 0.2;  // of the way, before contact
constexpr double deepest_m = 0.02;

/// Where an axis goes from and to.
struct Way {
  double from = 0.0;
  double to = 0.0;
  double seconds = stroke_s;
};

/// Minimum jerk from 0 to 1, and its rate of change.
std::pair<double, double> minimum_jerk(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return {s * s * s * (10.0 + s * (6.0 * s - 15.0)), 30.0 * s * s * (1.0 - s) * (1.0 - s)};
}

std::pair<double, double> along(const Way& way, double time_s) {
  const double length_s = way.seconds + pause_s;
  const double number = std::floor(time_s / length_s);
  const auto [place, rate] = minimum_jerk((time_s - number * length_s) / way.seconds);
  const bool back = std::fmod(number, 2.0) != 0.0;
  const double range = back ? way.from - way.to : way.to - way.from;
  return {(back ? way.to : way.from) + range * place, range * rate / way.seconds};
}

Way into_the_tissue(const LawFile& tissue, const drivers::AxisInfo& axis) {
  const models::Contact& contact = tissue.contact;
  const double limit = contact.direction > 0.0 ? axis.upper : axis.lower;
  double reach = 0.9 * std::abs(limit - contact.position);
  if (axis.position_unit == "m") reach = std::min(reach, deepest_m);
  return {.from = contact.position - contact.direction * free_share * reach,
          .to = contact.position + contact.direction * reach};
}

Way of_axis(const drivers::AxisInfo& axis, double seconds) {
  if (axis.name == "theta") return {.from = 0.6, .to = 0.05, .seconds = seconds};
  if (axis.name == "x_s") return {.from = 0.0, .to = 0.02, .seconds = seconds};
  const double reach = axis.position_unit == "m" ? 0.01 : 0.2;
  return {.from = -reach, .to = reach, .seconds = seconds};
}

drivers::DeviceInfo device_for(const LawFile& tissue) {
  std::string reason;
  for (const drivers::DeviceInfo& device : drivers::list_devices()) {
    try {
      (void)axes_for(tissue, device);
      return device;
    } catch (const std::invalid_argument& error) {
      reason = error.what();
    }
  }
  throw std::invalid_argument("no simulated device fits the scene: " + reason);
}

}  // namespace

ScriptedPath scripted_path(const Scene& scene) {
  const drivers::DeviceInfo device = device_for(scene.tissue);
  std::vector<Way> ways(device.axes.size());
  const auto axes = axes_for(scene.tissue, device);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const drivers::AxisInfo& axis = device.axes[axes[i]];
    ways[axes[i]] = scene.tissue.law.is_spatial()
                        ? of_axis(axis, stroke_s * (1.0 + 0.3 * static_cast<double>(i)))
                        : into_the_tissue(scene.tissue, axis);
  }
  return {.device = device, .at = [ways](double rate_hz) {
            TickPath path{.period_s = 1.0 / rate_hz, .position = {}, .velocity = {}};
            const auto ticks = static_cast<std::size_t>(strokes * (stroke_s + pause_s) * rate_hz);
            path.position.resize(ticks);
            path.velocity.resize(ticks);
            for (std::size_t tick = 0; tick < ticks; ++tick) {
              for (std::size_t axis = 0; axis < ways.size(); ++axis) {
                const auto [position, velocity] = along(ways[axis], static_cast<double>(tick) / rate_hz);
                path.position[tick][axis] = position;
                path.velocity[tick][axis] = velocity;
              }
            }
            return path;
          }};
}

}  // namespace kerf::bench

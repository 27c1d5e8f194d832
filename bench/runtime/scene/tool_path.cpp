#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/drivers/simulated_pose6.h>
#include <kerf/drivers/simulated_scissors.h>
#include <kerf/drivers/uri.h>

#include "scene/scene.h"

namespace kerf::bench {
namespace {

constexpr double ticks_at_most = 2e7;  // 2.2 GB

void follow(drivers::HandOptions options, double period_s, SampledMotion& path) {
  options.variation = 0.0;
  drivers::Strokes hand(options);
  for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
    const auto wish = hand.at(static_cast<double>(tick) * period_s);
    path.sample[tick] = {.position = {wish.angle_rad}, .velocity = {wish.speed_rad_s}};
  }
}

void follow(const drivers::PosePath::Options& options, double period_s, SampledMotion& path) {
  const drivers::PosePath hand(options);
  for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
    const auto wish = hand.at(static_cast<double>(tick) * period_s);
    path.sample[tick] = {.position = wish.position, .velocity = wish.velocity};
  }
}

void follow(std::monostate, double, SampledMotion&) {
  throw std::invalid_argument("the scene has no [trajectory]: it does not say what the hand does");
}

/// What the hand does: the scene's script, else what the device's URI says or leaves to its defaults.
Script script_of(const Scene& scene) {
  if (scene.trajectory.script.index() != 0) return scene.trajectory.script;
  drivers::Uri uri = drivers::parse_uri(device_of(scene));
  if (uri.name == "sim:scissors") return drivers::SimulatedScissors::parse_options(std::move(uri)).hand;
  if (uri.name != "sim:pose6") return {};
  const drivers::SimulatedPose6::Options options = drivers::SimulatedPose6::parse_options(std::move(uri));
  if (options.path) return *options.path;
  return {};
}

}  // namespace

SampledMotion tool_path(const Scene& scene, double rate_hz) {
  if (!(rate_hz >= 1.0 && rate_hz <= 1e6)) {
    throw std::invalid_argument(fmt::format("a rate of {} Hz is not from 1 Hz to 1 MHz", rate_hz));
  }
  const double ticks = std::round(scene.trajectory.seconds * rate_hz);
  if (ticks > ticks_at_most) {
    throw std::invalid_argument(fmt::format("{} s at {} Hz are {:.3g} ticks, more than {:.3g}",
                                            scene.trajectory.seconds, rate_hz, ticks, ticks_at_most));
  }
  const Script script = script_of(scene);
  SampledMotion path = ticks_at(rate_hz, static_cast<std::size_t>(ticks));
  std::visit([&](const auto& one) { follow(one, 1.0 / rate_hz, path); }, script);
  return path;
}

}  // namespace kerf::bench

#include "kerf/drivers/simulated_mechanism.h"

#include <algorithm>
#include <numbers>

namespace kerf::drivers {
namespace {

constexpr double sensor_noise_n = 0.02;
constexpr double sensor_step_n = 0.002;
constexpr double torque_sensor_m = 0.01;  // a six-axis sensor resolves torques as forces at so long a lever

double rounded_to(double value, double step) noexcept {
  return step > 0.0 ? step * std::round(value / step) : value;
}

void add_truth(DeviceInfo& info) {
  for (const AxisInfo& axis : info.axes) {
    info.channels.push_back({.name = axis.name + "_true", .unit = axis.position_unit});
  }
  for (const AxisInfo& axis : info.axes) {
    info.channels.push_back({.name = axis.name + "_force_true", .unit = axis.force_unit});
  }
}

}  // namespace

SimulatedMechanism::Options SimulatedMechanism::Options::from(UriOptions& given) {
  return {.with_noise = given.flag("noise", true),
          .with_encoder = given.flag("encoder", true),
          .with_truth = given.flag("truth", false),
          .seed = given.count("seed", 1)};
}

SimulatedMechanism::SimulatedMechanism(DeviceInfo info, const Options& options, Surroundings surroundings)
    : info_(std::move(info)),
      options_(options),
      count_(info_.axes.size()),
      first_truth_(info_.channels.size()),
      tissue_(std::move(surroundings.tissue)),
      tissue_of_axes_(std::move(surroundings.tissue_of_axes)),
      noise_(options.seed) {
  for (std::size_t at = 0; at < count_; ++at) {
    const AxisInfo& about = info_.axes[at];
    lever_[at] = about.lever;
    sensor_scale_[at] = about.force_unit == "N" ? 1.0 : torque_sensor_m;
    axes_[at].lower_m = about.lower * about.lever;
    axes_[at].upper_m = about.upper * about.lever;
  }
  if (options.with_truth) add_truth(info_);
}

Axes SimulatedMechanism::force_at(double time_s) const noexcept {
  const bool released = time_s > released_at_s_.load(std::memory_order_relaxed);
  Axes force{};
  for (std::size_t at = 0; at < count_; ++at) force[at] = (released ? 0.0 : command_[at]) + tissue_force_[at];
  return force;
}

void SimulatedMechanism::step(States& states, const Axes& force) noexcept {
  for (std::size_t at = 0; at < count_; ++at) {
    axes_[at].step(states[at],
                   {.equilibrium_m = equilibria_[at].travel_m,
                    .equilibrium_speed_m_s = equilibria_[at].speed_m_s,
                    .force_n = force[at]},
                   sub_step_s);
  }
}

void SimulatedMechanism::touch_tissue() noexcept {
  if (tissue_of_axes_) {
    Axes position{};
    Axes velocity{};
    for (std::size_t at = 0; at < count_; ++at) {
      position[at] = states_[at].travel_m / lever_[at];
      velocity[at] = states_[at].speed_m_s / lever_[at];
    }
    tissue_force_ = tissue_of_axes_(position, velocity, sub_step_s);
    return;
  }
  for (std::size_t at = 0; at < count_; ++at) {
    const SimulatedAxis::State& state = states_[at];
    if (const Tissue& tissue = tissue_[at]) {
      tissue_force_[at] = tissue(state.travel_m / lever_[at], state.speed_m_s / lever_[at], sub_step_s);
    }
  }
}

void SimulatedMechanism::measure(double now_s, Sample& sample) noexcept {
  for (std::size_t at = 0; at < count_; ++at) {
    const double truth = states_[at].travel_m / lever_[at];
    const double position = rounded_to(truth, options_.with_encoder ? info_.axes[at].resolution : 0.0);
    sample.position[at] = position;
    sample.velocity[at] = velocity_.update(at, position, now_s);
    sample.force_measured[at] =
        options_.with_noise ? rounded_to(tissue_force_[at] + sensor_scale_[at] * sensor_noise_n * noise_(),
                                         sensor_scale_[at] * sensor_step_n)
                            : tissue_force_[at];
    if (!options_.with_truth) continue;
    sample.channels[first_truth_ + at] = truth;
    sample.channels[first_truth_ + count_ + at] = tissue_force_[at];
  }
  velocity_.advance(now_s);
}

Status SimulatedMechanism::write(const Axes& force) noexcept {
  for (std::size_t at = 0; at < count_; ++at) {
    if (!std::isfinite(force[at])) {
      command_ = {};
      return Status::fault;
    }
    const double limit = info_.axes[at].force_limit;
    command_[at] = std::clamp(force[at], -limit, limit);
  }
  released_at_s_.store(never, std::memory_order_relaxed);
  return Status::ok;
}

void SimulatedMechanism::release(double at_s) noexcept {
  double expected = never;
  released_at_s_.compare_exchange_strong(expected, at_s, std::memory_order_relaxed);
}

}  // namespace kerf::drivers

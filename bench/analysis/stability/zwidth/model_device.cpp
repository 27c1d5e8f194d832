#include "stability/zwidth/model_device.h"

#include <algorithm>

namespace kerf::bench {

ModelDevice::ModelDevice(const SampledDevice& device, double force_limit_n)
    : moves_((check(device), device)), sensor_(device), line_(moves_.delay.ticks) {
  constexpr double reach_m = 10.0;
  info_ = {.uri = "model",
           .model = "model",
           .about = "one axis of a model, exact between the ticks",
           .axes = {{.name = "x",
                     .position_unit = "m",
                     .force_unit = "N",
                     .resolution = device.encoder_step_m,
                     .lower = -reach_m,
                     .upper = reach_m,
                     .force_limit = force_limit_n,
                     .slew_limit = force_limit_n / device.period_s,
                     .mechanics = drivers::Mechanics{.mass_kg = device.mass_kg,
                                                     .viscous_n_s_per_m = device.viscous_n_s_per_m,
                                                     .coulomb_n = device.coulomb_n}}},
           .channels = {},
           .simulated = true,
           .configuration = {},
           .mounts = {}};
}

drivers::Status ModelDevice::read(double, drivers::Sample& sample) noexcept {
  if (started_) {
    const double arrived_n = line_.pass(command_n_);
    if (moves_.delay.share > 0.0) motion_ = moves_.before.after(motion_, held_n_);
    held_n_ = arrived_n;
    motion_ = moves_.after.after(motion_, held_n_);
  }
  started_ = true;
  const AxisReading reading = sensor_.read(motion_.position_m);
  sample.position[0] = reading.position_m;
  sample.velocity[0] = reading.speed_m_s;
  return drivers::Status::ok;
}

drivers::Status ModelDevice::write(const drivers::Axes& force) noexcept {
  const double limit = info_.axes[0].force_limit;
  command_n_ = std::clamp(force[0], -limit, limit);
  return drivers::Status::ok;
}

void ModelDevice::release(double) noexcept { command_n_ = 0.0; }

}  // namespace kerf::bench

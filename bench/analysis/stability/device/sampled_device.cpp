#include "stability/device/sampled_device.h"

#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/drivers/velocity_filter.h>

namespace kerf::bench {

double SampledDevice::velocity_gain() const noexcept {
  return velocity_corner_rad_s > 0.0 ? -std::expm1(-velocity_corner_rad_s * period_s) : 1.0;
}

double whole_periods(double delay_s, double period_s) noexcept {
  return std::ceil(delay_s / period_s - 1e-9);
}

void check(const SampledDevice& device) {
  const auto demand = [](bool holds, const char* what, double value, const char* expected) {
    if (!holds) throw std::invalid_argument(fmt::format("{} is {}, expected {}", what, value, expected));
  };
  const auto not_negative = [&](const char* what, double value) {
    demand(value >= 0.0 && std::isfinite(value), what, value, "a number that is not negative");
  };
  demand(device.mass_kg > 0.0 && std::isfinite(device.mass_kg), "the device's mass", device.mass_kg,
         "a number greater than 0 kg");
  demand(device.period_s >= 1e-5 && device.period_s <= 1.0, "the period", device.period_s,
         "10 us to 1 s, that is 1 to 100000 Hz");
  not_negative("the viscous friction", device.viscous_n_s_per_m);
  not_negative("the Coulomb friction", device.coulomb_n);
  not_negative("the encoder step", device.encoder_step_m);
  not_negative("the corner of the velocity filter", device.velocity_corner_rad_s);
  not_negative("the hand's mass", device.hand.mass_kg);
  not_negative("the hand's damping", device.hand.damping_n_s_per_m);
  not_negative("the hand's stiffness", device.hand.stiffness_n_per_m);
  const double longest = device.period_s * static_cast<double>(SampledDevice::max_delay_ticks);
  demand(device.delay_s >= 0.0 && device.delay_s <= longest, "the delay", device.delay_s, "0 to 32 periods");
}

SampledDevice sampled_device(const drivers::DeviceInfo& device, std::size_t axis, double rate_hz) {
  const drivers::AxisInfo& about = device.axes.at(axis);
  if (!about.mechanics) {
    throw std::invalid_argument(
        fmt::format("{}: mass and friction of axis '{}' are not known; give --mass, --viscous and --coulomb",
                    device.uri, about.name));
  }
  SampledDevice sampled{
      .mass_kg = about.mechanics->mass_kg,
      .viscous_n_s_per_m = about.mechanics->viscous_n_s_per_m,
      .coulomb_n = about.mechanics->coulomb_n,
      .encoder_step_m = about.resolution * about.lever,
      .period_s = 1.0 / rate_hz,
      .delay_s = about.delay_s,
      .velocity_corner_rad_s = about.velocity_corner_rad_s.value_or(drivers::VelocityFilter::corner_rad_s)};
  check(sampled);
  return sampled;
}

}  // namespace kerf::bench

#include "stability/device/axis_request.h"

#include <stdexcept>

#include <fmt/core.h>

#include "laws/placement.h"
#include "stability/device/in_hand.h"

namespace kerf::bench {

std::size_t requested_axis(const AxisRequest& given, const drivers::DeviceInfo& info) {
  if (given.axis.empty()) return 0;
  for (std::size_t at = 0; at < info.axes.size(); ++at) {
    if (info.axes[at].name == given.axis) return at;
  }
  throw std::invalid_argument(
      fmt::format("{} has no axis '{}'; it has {}", info.uri, given.axis, names_in(info.axes)));
}

HandImpedance requested_hand(const AxisRequest& given) {
  HandImpedance hand = grip_named(given.grip);
  hand.mass_kg = given.hand_mass_kg.value_or(hand.mass_kg);
  hand.damping_n_s_per_m = given.hand_damping_n_s_per_m.value_or(hand.damping_n_s_per_m);
  hand.stiffness_n_per_m = given.hand_stiffness_n_per_m.value_or(hand.stiffness_n_per_m);
  return hand;
}

SampledDevice requested_device(const AxisRequest& given, const drivers::DeviceInfo& info, std::size_t axis) {
  SampledDevice device;
  const drivers::AxisInfo& about = info.axes[axis];
  if (about.mechanics) {
    device = sampled_device(info, axis, given.rate_hz);
  } else if (!given.mass_kg || !given.viscous_n_s_per_m || !given.coulomb_n) {
    throw std::invalid_argument(fmt::format(
        "{}: mass and friction of axis '{}' are not known; give --mass, --viscous and --coulomb, or "
        "--device-model",
        info.uri, about.name));
  } else {
    device.encoder_step_m = about.resolution * about.lever;
    device.delay_s = about.delay_s;
  }
  device.period_s = 1.0 / given.rate_hz;
  device.mass_kg = given.mass_kg.value_or(device.mass_kg);
  device.viscous_n_s_per_m = given.viscous_n_s_per_m.value_or(device.viscous_n_s_per_m);
  device.coulomb_n = given.coulomb_n.value_or(device.coulomb_n);
  device.encoder_step_m = given.encoder_step_m.value_or(device.encoder_step_m);
  device.velocity_corner_rad_s = given.velocity_corner_rad_s.value_or(device.velocity_corner_rad_s);
  device.delay_s = given.delay_s.value_or(device.delay_s);
  device.hand = requested_hand(given);
  check(device);
  return device;
}

}  // namespace kerf::bench

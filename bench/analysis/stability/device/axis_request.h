#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "stability/device/sampled_device.h"
#include "stability/tool_way.h"

namespace kerf::bench {

/// Which axis to study, in which hand. What is not given is as the device's model has it, or its driver.
struct AxisRequest {
  std::string device_uri = "sim:scissors";
  /// Its file; empty: the one that is kept of the device, if its driver knows less.
  std::string device_model;
  std::string axis;           ///< empty: the law's, else the first
  WayRequest way;             ///< through a law on several axes
  std::string grip = "none";  ///< grip_named()
  double rate_hz = 1000.0;
  std::optional<double> delay_s;
  std::optional<double> mass_kg, viscous_n_s_per_m, coulomb_n, encoder_step_m, velocity_corner_rad_s;
  std::optional<double> hand_mass_kg, hand_damping_n_s_per_m, hand_stiffness_n_per_m;
};

/// The axis that is asked for, by its number; the first where none is named.
/// @throws std::invalid_argument if the device has none of that name.
[[nodiscard]] std::size_t requested_axis(const AxisRequest& request, const drivers::DeviceInfo& device);
/// The hand that is asked for.
[[nodiscard]] HandImpedance requested_hand(const AxisRequest& request);
/// The axis of a device, with what is given in place of what its driver knows.
/// @throws std::invalid_argument if its mass and friction are neither known nor given, or out of range.
[[nodiscard]] SampledDevice requested_device(const AxisRequest& request, const drivers::DeviceInfo& device,
                                             std::size_t axis);

}  // namespace kerf::bench

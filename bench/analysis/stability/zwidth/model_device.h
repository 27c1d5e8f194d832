#pragma once

#include <memory>

#include <kerf/drivers/device.h>

#include "stability/device/sampled_loop.h"

namespace kerf::bench {

/// A SampledDevice as a device with one axis, "x" [m, N]: exact between the ticks, with its encoder, velocity
/// filter, delay and hand, for a loop in virtual time whose period it has. Each read is a period on.
class ModelDevice final : public drivers::Device {
 public:
  /// @throws std::invalid_argument as check().
  explicit ModelDevice(const SampledDevice& device, double force_limit_n = 100.0);

  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] drivers::Status read(double now_s, drivers::Sample& sample) noexcept override;
  [[nodiscard]] drivers::Status write(const drivers::Axes& force) noexcept override;
  void release(double at_s) noexcept override;

 private:
  drivers::DeviceInfo info_;
  DeviceMotion moves_;
  AxisSensor sensor_;
  CommandDelay line_;
  AxisMotion motion_;
  double command_n_ = 0.0;
  double held_n_ = 0.0;
  bool started_ = false;
};

}  // namespace kerf::bench

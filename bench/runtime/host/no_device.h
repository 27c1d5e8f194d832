#pragma once

#include <kerf/drivers/device.h>

namespace kerf::bench {

/// A device without axes: the loop around it is empty.
class NoDevice final : public drivers::Device {
 public:
  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] drivers::Status read(double, drivers::Sample&) noexcept override {
    return drivers::Status::ok;
  }
  [[nodiscard]] drivers::Status write(const drivers::Axes&) noexcept override { return drivers::Status::ok; }
  void release(double) noexcept override {}

 private:
  drivers::DeviceInfo info_;
};

}  // namespace kerf::bench

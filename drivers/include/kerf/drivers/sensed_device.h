#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>

namespace kerf::drivers {

/// A device whose forces are measured by a sensor beside it: any Device, and any other that measures force.
///
/// `force_measured` of an axis is the component that the sensor's ForceMount names for it, with its sign and
/// lever, or else that of the sensor's axis of the same name (x to rz). It is NaN on axes that no component
/// belongs to, and on all while the sensor has nothing to say: that is a gap in a measurement and no fault of
/// the device, which goes on rendering. A sensor that is lost ends the loop as a lost device does. The
/// sensor's channels come after the device's own; its settings stand under [sensor] in the configuration.
class SensedDevice final : public Device {
 public:
  /// @throws DeviceError if the sensor measures nothing that the device has an axis for, or units do not fit.
  SensedDevice(std::unique_ptr<Device> device, std::unique_ptr<Device> sensor);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  [[nodiscard]] Status write(const Axes& force) noexcept override { return device_->write(force); }
  void release(double at_s) noexcept override { device_->release(at_s); }
  /// Those of both.
  [[nodiscard]] std::vector<Figure> figures() const override;
  [[nodiscard]] std::string trouble() const override;

 private:
  /// Where the force of an axis comes from; factor 0: from nowhere.
  struct Source {
    std::size_t component = 0;
    double factor = 0.0;
  };
  void find_sources();

  std::unique_ptr<Device> device_;
  std::unique_ptr<Device> sensor_;
  DeviceInfo info_;
  std::array<Source, max_axes> sources_{};
  std::size_t own_channels_;
  Sample sensed_;
};

/// Opens a device and, unless `sensor_uri` is empty, the sensor of its forces: first the sensor, which moves
/// nothing. The device `none` is the sensor alone.
/// @throws DeviceError as open_device() and SensedDevice.
[[nodiscard]] std::unique_ptr<Device> open_device(std::string_view uri, std::string_view sensor_uri,
                                                  Surroundings surroundings);

}  // namespace kerf::drivers

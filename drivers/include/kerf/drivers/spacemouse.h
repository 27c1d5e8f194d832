#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/protocols/spacemouse.h>
#include <kerf/drivers/triple_buffer.h>
#include <kerf/drivers/uri.h>
#include <kerf/drivers/usb/hid_device.h>
#include <kerf/drivers/usb/io_thread.h>
#include <kerf/drivers/velocity_filter.h>

namespace kerf::drivers {

/// Every 3Dconnexion device that is attached, in one order.
[[nodiscard]] std::vector<usb::Attached> find_spacemice();

/// `spacemouse:N`: a 3Dconnexion cap as a source of trajectories, six axes and no force, on hidraw.
///
/// The cap's deflection, about +-350 as sent, is scaled to `reach` (x, y, z) and `swing` (rx, ry, rz). Frame:
/// x right, y away from the user, z up; rotations right-handed about them. The device sends y towards the
/// user and z down.
///
/// It is not a 1 kHz device: a SpaceNavigator sends each axis 62.5 times a second. Between reports the last
/// one is held, so that the velocity comes in spikes that the filter spreads; the channel `report_age` [s]
/// says how old it is, and the channel `buttons` has a bit for each. What it reads is up to 16 ms old, and
/// about 1 ms on the bus.
class SpaceMouse final : public Device {
 public:
  struct Options {
    double reach_m = 0.05;
    double swing_rad = 0.5;
  };
  static Options parse_options(Uri uri);

  static constexpr std::string_view about = "6-DOF input, no force; 62.5 Hz";

  /// @throws DeviceError
  SpaceMouse(std::string_view uri, std::size_t number, const Options& options);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  /// It has no motors: any force is taken and none is exerted.
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double) noexcept override {}
  [[nodiscard]] std::vector<Figure> figures() const override;

 private:
  struct Report {
    spacemouse::State state;
    std::int64_t at_ns = 0;
  };
  void listen(const std::stop_token& stop) noexcept;

  DeviceInfo info_;
  Options options_;
  usb::HidDevice device_;
  TripleBuffer<Report> latest_;
  Report report_;
  std::atomic<bool> lost_{false};
  std::atomic<std::uint64_t> reports_{0};
  std::atomic<std::uint64_t> refused_{0};
  VelocityFilter velocity_;
  std::int64_t opened_ns_;
  usb::IoThread thread_;  ///< last: it ends first
};

}  // namespace kerf::drivers

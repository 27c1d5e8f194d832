#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/report_velocity.h>
#include <kerf/drivers/uri.h>
#include <kerf/drivers/usb/guard.h>
#include <kerf/drivers/usb/io_thread.h>
#include <kerf/drivers/usb/usb_device.h>

namespace kerf::drivers {

class FalconLink;

/// Every Novint Falcon that is attached.
[[nodiscard]] std::vector<usb::Attached> find_falcons();

/// `falcon:N`: the Novint Falcon, three axes with force, by libusb; its own program is not needed.
///
/// Axes x (right), y (up), z (out, towards the user) of the knob in metres, origin in the base, as
/// mechanisms::Falcon has them; force in N on the knob. A force F becomes arm torques tau by the transposed
/// Jacobian at the last position and motor values V = -K tau, all three scaled alike where one exceeds 4095,
/// so that the force keeps its direction. K is a calibration that is not settled (`torque_scale`), and so
/// newtons are nominal.
///
/// Firmware is not in the device when it is switched on, and Kerf ships none: `firmware=FILE` gives the image
/// that came with a Falcon. It stays until the device is switched off.
///
/// Counts are from where the knob stood when it was switched on until it is homed: a person pulls the knob
/// fully out and pushes it fully in. The constructor waits for that while the LED is red. With `homing=off`
/// it does not, and the position is that of a knob which stood at arm angles of 35 deg; limits are the same.
///
/// Latency, of the protocol and in the guest with its emulator: with a tick each millisecond what read()
/// gives is at most 1.3 ms old, 3.3 ms where ticks are rarer. A force is on its way at once if no answer is
/// outstanding, and reaches the motors within 0.3 ms; else with the next answer, within 1.3 ms. One command
/// is under way at a time; one whose answer does not come within 5 ms is sent again. Without a command for
/// 50 ms the motors are let go, and by the guard when this program dies or hangs (usb/guard.h).
class Falcon final : public Device {
 public:
  enum class Led : std::uint8_t { off, red, green, blue };

  struct Options {
    std::string firmware;            ///< path of an image; empty: it must be loaded already
    bool homing = true;              ///< wait until it is homed
    double homing_timeout_s = 60.0;  ///< 0.1 to 3600
    Led led = Led::green;            ///< once it is homed
    double units_per_n_m = 10000.0;  ///< K, torque_scale, 1000 to 30000
  };
  static Options parse_options(Uri uri);

  static constexpr std::string_view about = "Novint Falcon, 3 axes with force; needs its firmware";

  /// Bits of Sample::faults.
  static constexpr std::uint32_t force_was_limited =
      1;  ///< the last write() asked for more than the motors give

  /// @throws DeviceError
  Falcon(std::string_view uri, std::size_t number, const Options& options,
         const std::atomic<bool>* stop = nullptr);
  ~Falcon() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  /// Fault without a report for 20 ms, outside of the workspace, and where homing was lost; lost after 1 s or
  /// when unplugged.
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  /// Fault, and zero, also where the guard has died.
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double at_s) noexcept override;
  [[nodiscard]] std::vector<Figure> figures() const override;

 private:
  void wait_for_report(const std::atomic<bool>* stop);
  void wait_until_homed(const std::atomic<bool>* stop);

  Options options_;
  DeviceInfo info_;
  usb::UsbDevice device_;
  std::optional<usb::Guard> guard_;
  std::unique_ptr<FalconLink> link_;
  ReportVelocity velocity_{3};
  bool limited_ = false;
  std::atomic<std::uint64_t> limited_ticks_{0};
  usb::IoThread thread_;  ///< last: it ends first, and lets the motors go
};

}  // namespace kerf::drivers

#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/drivers/report_velocity.h>
#include <kerf/drivers/uri.h>
#include <kerf/drivers/usb/guard.h>
#include <kerf/drivers/usb/io_thread.h>
#include <kerf/drivers/usb/usb_device.h>
#include <kerf/mechanisms/woodenhaptics.h>

namespace kerf::drivers {

class WoodenHapticsLink;

/// What a WoodenHaptics said last.
struct WoodenHapticsReading {
  std::array<int, 3> count{};
  std::array<int, 3> gimbal{};
  bool button = false;
  std::int64_t at_ns = 0;  ///< when it arrived, or an earlier time at which it may have been true
};

/// WoodenHaptics and Polhem, three motors on capstans, by HID reports: `hid:1234:0006` (V1 and V2, told apart
/// by the length of their reports) and `hid:16c0:0486` (V3). By libusb, which takes the interface from the
/// kernel's usbhid while the device is open: a write to a hidraw node cannot be given up, and a node can be
/// opened by others.
///
/// Axes x (towards the user), y (right) and z (up) of the tip, in metres, in the frame of
/// mechanisms::WoodenHaptics. The encoders count from where the device was switched on, so that must have
/// been its home, or `calibrate=on` says that the tip is there now. Forces are cut to the model's largest one
/// an axis; currents to what the motors bear, all alike, so that the force keeps its direction.
///
/// V1 sends a report each millisecond by itself and takes an order a millisecond: a position is up to 1 ms
/// old, and a force reaches the motors up to 1 ms (the interrupt OUT) and one turn of the device's loop after
/// it was written. V2 and V3 answer each order with one report: an order and a report a frame, 1000 a second
/// at most, a position up to 1 ms old when it arrives. If no answer comes within 10 ms the order is sent
/// again.
///
/// The device makes its force zero after 0.5 s without an order. The driver does not wait for that: a command
/// older than 50 ms is not held any longer, because the loop that gave it is dead; and the guard lets go when
/// this program dies or hangs (usb/guard.h).
class WoodenHaptics final : public Device {
 public:
  struct Product {
    std::uint16_t vendor;
    std::uint16_t product;
    std::string_view scheme;  ///< "hid:1234:0006"
    std::string_view what;
    std::string_view about;
    std::string_view model;  ///< if the URI names none
  };
  [[nodiscard]] static const std::array<Product, 2>& products() noexcept;
  /// The one of a URI's name. @throws DeviceError if there is none, naming those that there are.
  [[nodiscard]] static const Product& product(std::string_view name);
  [[nodiscard]] static std::vector<usb::Attached> find(const Product& product);

  struct Options {
    std::size_t index = 0;  ///< which of several
    const mechanisms::WoodenHaptics::Configuration* model = nullptr;
    double max_current_a = 0.0;  ///< of a motor; at most the model's
    bool calibrate = false;      ///< the tip is at home now: count from here
    bool preset = false;         ///< the same, and the device shall count so too (V2, V3)
  };
  /// Reads index, model, most_current, calibrate (on, off) and preset (home). @throws DeviceError
  static Options parse_options(Uri uri, const Product& product);

  /// @param stop ends the wait for the first report when it becomes true
  /// @throws DeviceError
  WoodenHaptics(std::string_view uri, const Product& product, const Options& options,
                const std::atomic<bool>* stop = nullptr);
  ~WoodenHaptics() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  /// Fault without a report for 20 ms and where counters are of no place; lost after 1 s or when unplugged.
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override;
  /// Fault also where the device takes no orders, for 20 ms or three in a row, and, with zero, where the
  /// guard has died.
  [[nodiscard]] Status write(const Axes& force) noexcept override;
  void release(double at_s) noexcept override;
  [[nodiscard]] std::vector<Figure> figures() const override;

 private:
  // Set-up.
  [[nodiscard]] woodenhaptics::Generation recognise(const Product& product);
  void meet(const Product& product, const std::atomic<bool>* stop);
  void send(std::span<const std::uint8_t> order);
  [[nodiscard]] woodenhaptics::Report first_report(const Product& product, const std::atomic<bool>* stop);
  void describe(std::string_view uri, const Product& product);
  [[nodiscard]] std::string configuration() const;

  void take() noexcept;

  Options options_;
  usb::UsbDevice device_;
  std::optional<usb::Guard> guard_;
  woodenhaptics::Generation generation_;
  mechanisms::WoodenHaptics mechanism_;
  DeviceInfo info_;
  std::array<int, 3> home_count_{};
  std::unique_ptr<WoodenHapticsLink> link_;

  WoodenHapticsReading last_;
  std::array<int, 3> count_{};  ///< from home
  mechanisms::WoodenHaptics::Vector tip_ = mechanisms::WoodenHaptics::Vector::Zero();
  bool reachable_ = false;  ///< the counters are of a place; else the tip is the last that was one
  std::array<int, 3> last_sent_{};
  ReportVelocity velocity_{3};
  std::atomic<std::uint64_t> limited_{0};

  std::int64_t opened_ns_ = 0;
  usb::IoThread thread_;  ///< last: it ends first, and lets the motors go
};

}  // namespace kerf::drivers

#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/force_calibration.h>
#include <kerf/drivers/protocols/labjack_u6.h>
#include <kerf/drivers/protocols/labjack_u6_commands.h>
#include <kerf/drivers/scan_clock.h>
#include <kerf/drivers/streamed_force.h>
#include <kerf/drivers/uri.h>
#include <kerf/drivers/usb/io_thread.h>
#include <kerf/drivers/usb/usb_device.h>

namespace kerf::drivers {

/// Every LabJack U6 that is attached.
[[nodiscard]] std::vector<usb::Attached> find_labjack_u6();

/// `u6:N?calibration=FILE.toml`: a six-axis force/torque transducer on the analogue inputs of a LabJack U6,
/// by libusb.
///
/// AIN0/1, 2/3, ... 10/11 are read as six differential channels of +-10 V, 16 bits, once a millisecond by the
/// U6's own clock; its own calibration constants make volts of codes and ForceCalibration makes a wrench of
/// volts. The axes are `x` to `rz`, at rest at 0, since it does not move: only `force_measured` says
/// something, in N and N·m in the transducer's frame. One code is 0.32 mV.
///
/// Channels: `force_scan` is the number of the scan, which jumps where scans were lost, and `force_age` [s]
/// how much older than the tick it is on the loop's clock, by the line of ScanClock; so the scan was taken at
/// time - force_age. A scan older than 20 ms is no measurement of this tick: force_measured is then NaN and
/// the answer is Status::fault. After a second without a scan it is lost.
///
/// Latency: a packet leaves with the last channel of its scan and takes one USB frame, so a tick sees a scan
/// that is up to one period and some 0.2 ms of transport old. What is the same for all packets (the end of
/// the scan, the frame) is not in `force_age`: by the data sheet at most about 0.3 ms. The six channels are
/// sampled one after the other, a settling time of some tens of us apart; all are given the time of the scan.
///
/// A packet with a wrong checksum, or one that is missing, and scans that did not find room in the U6 are
/// gaps of `force_scan` and never shift a channel. A stream that stops for 230 ms (the packets' counter wraps
/// after 256), stalls or has lost count is started anew by the I/O thread, and the gap has as many scans as
/// the clock says; if that fails, the device is lost.
class ForceSensorU6 final : public Device {
 public:
  struct Options {
    std::string calibration_file;  ///< empty: none, with `raw` alone
    bool raw = false;  ///< channels `signal_1` to `signal_6` [V]; force is NaN without a calibration
  };
  /// @throws DeviceError, also if no calibration is named: volts are no force.
  static Options parse_options(std::string_view text, Uri uri);

  static constexpr std::string_view about =
      "force/torque transducer on a LabJack U6; 1000 Hz; needs calibration=FILE.toml";

  /// @throws DeviceError
  ForceSensorU6(std::string_view uri, std::size_t number, const Options& options);
  ForceSensorU6(const ForceSensorU6&) = delete;
  ForceSensorU6& operator=(const ForceSensorU6&) = delete;
  ~ForceSensorU6() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override {
    return force_.read(now_s, sample);
  }
  [[nodiscard]] Status write(const Axes& force) noexcept override { return force_.write(force); }
  void release(double) noexcept override {}
  /// scan_rate, scans, scans_lost, checksum_errors, overflows, restarts, and once there are four blocks of
  /// ScanClock clock_drift and clock_drift_error.
  [[nodiscard]] std::vector<Figure> figures() const override;

 private:
  // Set-up and restart, on one thread at a time.
  [[nodiscard]] std::size_t ask(const labjack_u6::Message& question, std::span<std::uint8_t> answer);
  [[noreturn]] void refuse(const std::string& why) const;
  void identify();
  void read_constants();
  void configure();
  void drain() noexcept;
  void stop_stream();
  void start_stream();
  void note_doubts(const std::string& file);

  // The I/O thread.
  void stream(const std::stop_token& stop) noexcept;
  void take_packet(std::span<const std::uint8_t> bytes) noexcept;
  void take_scan(std::uint64_t number, std::span<const std::uint16_t> codes,
                 std::int64_t arrived_ns) noexcept;
  bool restart() noexcept;

  std::string uri_;
  ForceCalibration calibration_;
  bool raw_;
  usb::UsbDevice usb_;
  labjack_u6::Identification identification_;
  labjack_u6::Calibration volts_;
  DeviceInfo info_;

  // Of the I/O thread.
  std::vector<std::unique_ptr<usb::Transfer>> transfers_;
  labjack_u6::ScanAssembler assembler_;
  ScanClock clock_;
  std::uint64_t first_number_ = 0;  ///< of this stream's first scan
  std::uint64_t next_number_ = 0;   ///< after the last scan
  std::uint64_t lost_before_ = 0;   ///< scans that were lost before this stream began
  std::int64_t last_packet_ns_ = 0;
  bool broken_ = false;
  bool was_recovering_ = false;

  // Between the threads.
  StreamedForce force_;  ///< extras: the volts, with `raw`
  /// Of the first readings: sums of the I/O thread, until there are as many as the bias is looked at by.
  Axes opening_sum_{};
  std::atomic<std::size_t> opening_count_{0};
  std::atomic<std::uint64_t> scans_{0};
  std::atomic<std::uint64_t> scans_lost_{0};
  std::atomic<std::uint64_t> checksum_errors_{0};
  std::atomic<std::uint64_t> overflows_{0};
  std::atomic<std::uint64_t> restarts_{0};
  std::atomic<std::int64_t> first_ns_{0};
  std::atomic<std::int64_t> last_ns_{0};
  std::atomic<double> drift_ppm_{0.0};
  std::atomic<double> drift_error_ppm_{std::numeric_limits<double>::infinity()};

  usb::IoThread thread_;  ///< last: it ends first
};

}  // namespace kerf::drivers

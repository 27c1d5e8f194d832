#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/force_calibration.h>
#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/protocols/labjack_u6.h>
#include <kerf/drivers/uri.h>

#include "emulated_device.h"
#include "swaying_wrench.h"

namespace kerf::emulators {

/// The transducer that the emulator has on its inputs unless told otherwise: the one of
/// examples/u6.calibration.toml.
[[nodiscard]] const drivers::ForceCalibration& example_transducer();

/// A LabJack U6 (0cd5:0006) with a six-axis force/torque transducer on AIN0/1 to AIN10/11, on which a
/// SwayingWrench acts from the first StreamStart on. It becomes volts by the inverse of the transducer's
/// matrix, and codes by the inverse of the U6's own constants, rounded and cut to 16 bits. All channels of a
/// scan are sampled at one instant (a real one takes some tens of us from channel to channel). A converter of
/// 16 bits, 984 samples of buffer and a clock that may run wrong stand between that and the host: when the
/// host does not read, the buffer fills, what is in it comes with error 59 and then one dummy scan with error
/// 60 and the count of those that are missing.
///
/// Options: force (8N), torque (0.4Nm): the amplitudes; calibration=FILE.toml: another transducer; drift
/// (0ppm): by how much its millisecond is longer than the host's; noise (0): of the converter, its deviation
/// in codes; trim (0ppm): by how much its constants differ from the nominal ones; serial; overflow (2.0s
/// after StreamStart, once): for 0.19 s no packet leaves, so that the buffer overflows; trace=FILE.csv:
/// number of the scan, its time by the device's clock from StreamStart and by the host's monotonic one, and
/// its wrench.
///
/// Descriptors and strings are made up where the vendor tells nothing of them.
class EmulatedU6 final : public EmulatedDevice {
 public:
  struct Options {
    SwayingWrench wrench;
    drivers::ForceCalibration transducer = example_transducer();
    double drift_ppm = 0.0;
    double noise_codes = 0.0;
    double trim_ppm = 0.0;
    std::uint32_t serial = 360000001;
    double overflow_s = 0.0;  ///< 0: never
    std::string trace;
  };
  static Options parse_options(drivers::Uri uri);
  explicit EmulatedU6(const Options& options);

  [[nodiscard]] const Description& description() const override;
  std::optional<Bytes> control(const Setup& setup, std::span<const std::uint8_t> data,
                               std::int64_t now_ns) override;
  void receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, std::int64_t now_ns) override;
  std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                  std::int64_t waits_since_ns, std::int64_t now_ns,
                                  Disturbance& next) override;
  [[nodiscard]] std::optional<std::int64_t> next_event_ns(std::int64_t now_ns) const override;
  [[nodiscard]] std::string tell() const override;

  /// What acts `time_s` after the first StreamStart.
  [[nodiscard]] drivers::Axes wrench(double time_s) const noexcept;
  /// What it would answer to ReadCal: four constants a block, 0 to 9.
  [[nodiscard]] std::array<double, 4> constants(std::uint8_t block) const noexcept;

 private:
  struct StreamChannel {
    std::uint8_t number = 0;
    std::uint8_t options = 0;
  };

  // Commands.
  [[nodiscard]] Bytes answer(std::span<const std::uint8_t> command, std::int64_t now_ns);
  [[nodiscard]] Bytes answer_extended(std::span<const std::uint8_t> command, std::int64_t now_ns);
  [[nodiscard]] Bytes config_u6(std::span<const std::uint8_t> command);
  [[nodiscard]] Bytes config_io(std::span<const std::uint8_t> command);
  [[nodiscard]] Bytes config_timer_clock(std::span<const std::uint8_t> command);
  [[nodiscard]] Bytes read_constants(std::span<const std::uint8_t> command) const;
  [[nodiscard]] Bytes feedback(std::span<const std::uint8_t> command, std::int64_t now_ns);
  /// What one IOType sends back is appended; false if there is no such one.
  [[nodiscard]] bool feed_back(std::span<const std::uint8_t> io, Bytes& data, std::int64_t now_ns);
  [[nodiscard]] Bytes stream_config(std::span<const std::uint8_t> command);
  [[nodiscard]] std::uint8_t start_stream(std::int64_t now_ns);
  [[nodiscard]] std::uint8_t stop_stream();

  // Signals.
  [[nodiscard]] static double volts(std::uint8_t channel, const drivers::Axes& inputs) noexcept;
  /// Code of a voltage, 0 to 65535, not yet rounded.
  [[nodiscard]] double code(double volts, unsigned gain) const noexcept;
  [[nodiscard]] drivers::Axes inputs(double time_s) const noexcept;
  [[nodiscard]] std::uint16_t sample(const StreamChannel& channel, const drivers::Axes& inputs) noexcept;
  [[nodiscard]] double world_s(std::int64_t now_ns) const noexcept;

  // The stream.
  [[nodiscard]] std::int64_t scan_ns(std::uint64_t scan) const noexcept;
  [[nodiscard]] std::uint64_t scans_due(std::int64_t now_ns) const noexcept;
  void run_until(std::int64_t now_ns);
  void take_scan(std::uint64_t scan);
  void end_recovery();
  [[nodiscard]] bool is_blocked(std::int64_t now_ns) const noexcept;
  [[nodiscard]] bool has_packet() const noexcept;
  [[nodiscard]] drivers::labjack_u6::Message next_packet();
  std::optional<std::size_t> send_stream(std::span<std::uint8_t> buffer, std::int64_t now_ns,
                                         Disturbance& next);

  Options options_;
  Eigen::Matrix<double, 6, 6> to_volts_;
  drivers::Gaussian noise_{1};
  std::ofstream trace_;
  std::deque<Bytes> answers_;
  std::uint64_t commands_ = 0;

  std::uint8_t local_id_ = 1;
  std::array<std::uint8_t, 2> timers_{};  ///< timers and counters that are on, always none; the pins' offset
  std::array<std::uint8_t, 2> timer_clock_{};
  bool led_ = true;
  std::array<std::uint32_t, 3> port_state_{0xFF, 0xFF, 0x0F};  ///< FIO, EIO, CIO
  std::array<std::uint32_t, 3> port_direction_{};
  std::array<std::uint16_t, 2> dac_{};

  std::vector<StreamChannel> channels_;
  std::size_t samples_per_packet_ = 25;
  double interval_ns_ = 1e6;
  bool streaming_ = false;
  std::int64_t world_start_ns_ = -1;
  std::int64_t stream_start_ns_ = 0;
  std::int64_t blocked_from_ns_ = -1;
  std::uint64_t next_scan_ = 0;
  std::deque<std::uint16_t> fifo_;
  bool recovering_ = false;
  std::uint64_t missing_from_ = 0;  ///< first scan that found no room
  std::size_t dummy_after_ = 0;     ///< samples before the dummy scan, while there is one in the buffer
  std::uint32_t dummy_stands_for_ = 0;
  std::uint8_t counter_ = 0;
  Bytes rest_of_split_;
  std::uint64_t packets_ = 0;
  std::uint64_t scans_lost_ = 0;
};

}  // namespace kerf::emulators

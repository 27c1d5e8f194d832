#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/force_intake.h>
#include <kerf/drivers/streamed_force.h>
#include <kerf/drivers/uri.h>
#include <kerf/drivers/usb/io_thread.h>

namespace kerf::drivers {

/// One make of force sensor that sends frames by itself, on its wire. It is opened by its constructor, which
/// throws DeviceError; what follows throws nothing, and is one thread's.
class ForceSource {
 public:
  ForceSource() = default;
  ForceSource(const ForceSource&) = delete;
  ForceSource& operator=(const ForceSource&) = delete;
  virtual ~ForceSource() = default;

  /// Readable where something has arrived.
  [[nodiscard]] virtual int descriptor() const noexcept = 0;
  /// Asks for frames; again, where none come.
  virtual void ask() noexcept = 0;
  /// Takes what has arrived, without waiting.
  virtual void take(ForceIntake& intake) noexcept = 0;
  /// Asks it to send no more.
  virtual void end() noexcept = 0;

  /// The rate that it was set to or tells; nothing where nobody knows.
  [[nodiscard]] virtual std::optional<double> told_rate_hz() const = 0;
  /// What it would make of a rate that was measured instead, if it has rates of its own.
  [[nodiscard]] virtual std::optional<double> rate_near(double /*measured_hz*/) const { return std::nullopt; }
  /// What mends that no frame has come; `wrong` of what came were none.
  [[nodiscard]] virtual std::string silence(std::uint64_t wrong) const = 0;
  /// Model, about, serial, the sensor's further channels and its settings as TOML.
  [[nodiscard]] virtual DeviceInfo describe() const = 0;
  /// What its last status says, for a person; empty: nothing.
  [[nodiscard]] virtual std::string trouble() const = 0;
};

/// A force/torque sensor that streams by its own clock, as `--sensor` of a device or alone. Axes and signs as
/// ForceSensorU6 has them; at rest at 0, for it does not move.
///
/// Channels: `force_age` [s] and `force_scan` as StreamedForce says, `force_lost`, how many frames were lost
/// so far, then those of the source: counts and status words of its own, as they come. The time of a frame is
/// that of the line of ScanClock over its number, which follows a rate up to 2 % from what was told: what all
/// frames take alike, the sensor's filter among it, is not in `force_age`.
///
/// After 100 ms without a frame it is asked again, every 100 ms; after a second it is lost, and so it is
/// where what comes is never a frame.
class StreamingForceSensor final : public Device {
 public:
  struct Options {
    StreamedForce::Rule rule = StreamedForce::Rule::latest;
    std::optional<double> delay_s{};   ///< of `interpolated`; not given: two periods
    std::vector<ForceMount> mounts{};  ///< which component acts on which axis of the device beside it
  };
  /// resample, delay, axes: what every such sensor takes. @throws DeviceError
  static Options parse_options(UriOptions& given);

  /// Waits at most a second for the first frame. @throws DeviceError
  StreamingForceSensor(std::string_view uri, std::unique_ptr<ForceSource> source, const Options& options);
  StreamingForceSensor(const StreamingForceSensor&) = delete;
  StreamingForceSensor& operator=(const StreamingForceSensor&) = delete;
  ~StreamingForceSensor() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override {
    return intake_.force().read(now_s, sample);
  }
  [[nodiscard]] Status write(const Axes& force) noexcept override { return intake_.force().write(force); }
  void release(double) noexcept override {}
  [[nodiscard]] std::vector<Figure> figures() const override { return intake_.figures(); }
  [[nodiscard]] std::string trouble() const override;

 private:
  [[noreturn]] void refuse(const std::string& why) const;
  void wait_for_frames();
  [[nodiscard]] double find_rate();
  void describe(const Options& options, double rate_hz);
  void wait_and_take(std::int64_t most_ns) noexcept;
  void stream(const std::stop_token& stop) noexcept;

  std::string uri_;
  std::unique_ptr<ForceSource> source_;
  DeviceInfo info_;
  ForceIntake intake_;
  usb::IoThread thread_;  ///< last: it ends first
};

/// "theta:-tz/36.9mm,x_s:fx": the component of an axis, its sign, and the lever between a torque and an axis
/// in N, or a force and one in N·m. @throws DeviceError
[[nodiscard]] std::vector<ForceMount> parse_mounts(std::string_view text);

}  // namespace kerf::drivers

#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <kerf/drivers/gaussian.h>
#include <kerf/drivers/uri.h>

#include "emulated_device.h"
#include "faults.h"
#include "serial/pseudo_port.h"
#include "swaying_wrench.h"

namespace kerf::emulators {

/// A force sensor on a serial line, played on a pseudo-terminal at the pace of its speed, ten bits a byte: a
/// SwayingWrench acts from the first opening on. What it hears and says is the derived one's.
///
/// Options of each: link=PATH, a name for its port; force (8N), torque (0.4Nm), noise (0N); drift (0ppm) of
/// its clock; loss (0), the share of frames that never leave, drawn by seed (1); trace=FILE.csv: each frame
/// with its number, the moment of its reading on the host's monotonic clock, its wrench, whether it left.
class EmulatedSerialSensor : public EmulatedOnLine {
 public:
  struct Options {
    std::string link;
    SwayingWrench wrench;
    double noise_n = 0.0;
    double drift_ppm = 0.0;
    double loss = 0.0;
    std::uint64_t seed = 1;
    std::string trace;
  };
  [[nodiscard]] const std::string& path() const noexcept override { return port_.path(); }
  void run(const std::atomic<bool>& stop, double seconds) override;
  [[nodiscard]] std::string tell() const override;

 protected:
  EmulatedSerialSensor(const Options& options, std::vector<Fault> faults, double baud);
  /// Takes those of every sensor out.
  static Options parse_common(drivers::UriOptions& given);

  /// What is measured in one frame, or one answer.
  struct Measured {
    double time_s = 0.0;     ///< from the first opening on
    double powered_s = 0.0;  ///< since it has power
    std::uint64_t number = 0;
    std::array<double, 6> wrench{};  ///< N, N·m
    bool overloaded = false;
  };
  /// Somebody has opened its port.
  virtual void opened() {}
  /// The host has sent bytes, in one burst or as the first ones of it.
  virtual void hear(std::span<const std::uint8_t> bytes) = 0;
  /// Nothing has come for three milliseconds after a burst.
  virtual void heard_all() {}
  [[nodiscard]] virtual Bytes frame(const Measured& measured) = 0;
  /// It has power again.
  virtual void begin_anew() {}

  /// A reading that is asked for, outside of a stream; traced as one that left.
  [[nodiscard]] Measured read_out();
  void say(const Bytes& bytes);
  void say(const std::string& text);
  void stream(double rate_hz);
  void stop_stream() noexcept { rate_hz_ = 0.0; }
  [[nodiscard]] bool streams() const noexcept { return rate_hz_ > 0.0; }

 private:
  void listen(std::int64_t now_ns);
  void send_due(std::int64_t now_ns);
  void measure(std::int64_t taken_ns);
  [[nodiscard]] Measured measured_at(std::int64_t taken_ns);
  void note(const Measured& measured, std::int64_t taken_ns, bool leaves);
  void set_power(bool on, std::int64_t now_ns);
  [[nodiscard]] double world_s(std::int64_t at_ns) const noexcept;
  [[nodiscard]] std::int64_t frame_ns(std::uint64_t frame) const noexcept;

  Options options_;
  FaultPlan faults_;
  PseudoPort port_;
  PacedLine line_;
  std::ofstream trace_;
  drivers::Gaussian noise_;
  std::mt19937_64 losses_;
  std::int64_t began_ns_;
  std::optional<std::int64_t> world_start_ns_;  ///< its first opening
  std::int64_t powered_ns_ = 0;
  bool has_power_ = true;
  bool was_open_ = false;
  std::optional<std::int64_t> heard_ns_;
  double rate_hz_ = 0.0;
  std::int64_t stream_start_ns_ = 0;
  std::uint64_t measured_of_stream_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t sent_ = 0;
  std::uint64_t left_out_ = 0;
};

/// Bota, OptoForce, FT300 or the toy: `bota`, `optoforce`, `ft300`, `gauge`; nothing for another name.
/// @throws drivers::DeviceError for an option that there is not.
[[nodiscard]] std::unique_ptr<EmulatedOnLine> make_serial_sensor(drivers::Uri uri, std::vector<Fault> faults);

}  // namespace kerf::emulators

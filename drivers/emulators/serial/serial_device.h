#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <kerf/drivers/uri.h>

#include "devices/free_tip.h"
#include "devices/held_tip.h"
#include "emulated_device.h"
#include "faults.h"
#include "serial/pseudo_port.h"

namespace kerf::emulators {

/// A haptic device on a serial line, played on a pseudo-terminal at the pace of its speed: a HeldTip that its
/// motors move from the first opening on. What it hears and says is the derived one's. It is looked after
/// every quarter of a millisecond, and whenever something has come.
///
/// Options of each: link=PATH, a name for its port; sway of the hand; hand=off with mass, viscous, coulomb,
/// delay (FreeTip); trace=FILE.csv: each force and each frame with its moment on the host's monotonic clock.
class EmulatedSerialDevice : public EmulatedOnLine {
 public:
  struct Options {
    std::string link;
    double sway_m = 0.01;
    std::optional<FreeTip::Options> free;
    std::string trace;
  };
  [[nodiscard]] const std::string& path() const noexcept override { return port_.path(); }
  void run(const std::atomic<bool>& stop, double seconds) override;
  [[nodiscard]] std::string tell() const override;

 protected:
  EmulatedSerialDevice(const Options& options, HeldTip::Options tip, std::vector<Fault> faults, double baud);
  /// Takes those of every device out.
  static Options parse_common(drivers::UriOptions& given);

  /// The host has sent bytes, in one burst or as the first ones of it.
  virtual void hear(std::span<const std::uint8_t> bytes) = 0;
  /// A frame that it sends by itself; nothing of one that only answers.
  [[nodiscard]] virtual Bytes frame() { return {}; }
  /// Time has passed, and the tip has moved.
  virtual void moved() {}
  /// Nothing has fed its watchdog for too long: the force is zero now.
  virtual void let_go_by_watchdog() {}
  /// It has power again.
  virtual void begin_anew() = 0;

  /// Whenever it gets power it says and hears nothing for so long.
  void boot_for(double seconds) noexcept { boot_ns_ = std::llround(1e9 * seconds); }
  /// Of frames that it sends by itself, each so much later than it was measured.
  void stream(double rate_hz, double later_s = 0.0) noexcept {
    rate_hz_ = rate_hz;
    later_s_ = later_s;
  }
  /// After so long without feed_watchdog() the force is zero; 0: it is held for ever.
  void set_watchdog(double seconds) noexcept { watchdog_s_ = seconds; }
  void feed_watchdog() noexcept { fed_ns_ = now_ns_; }
  /// Where the hand wants to be, beside its sway, from where the tip began.
  void lead(const Eigen::Vector3d& offset_m) noexcept { tip_.lead(offset_m); }
  /// The force of the motors, from now on; as it changes with the pose, and no event.
  void adjust(const Eigen::Vector3d& force_n) { tip_.push(force_n); }
  /// The force of the motors, from now on.
  void push(const Eigen::Vector3d& force_n, std::string_view event = "force");
  [[nodiscard]] Eigen::Vector3d position() const noexcept { return tip_.position(); }
  /// Through what goes wrong on the way, and the line; so much later.
  void say(Bytes bytes, double later_s = 0.0);
  [[nodiscard]] double world_s() const noexcept {
    return world_start_ns_ ? 1e-9 * static_cast<double>(now_ns_ - *world_start_ns_) : 0.0;
  }

 private:
  void set_power(bool on);
  void listen();
  void send_due_frames();
  void note(std::string_view event);

  Options options_;
  FaultPlan faults_;
  PseudoPort port_;
  PacedLine line_;
  HeldTip tip_;
  std::ofstream trace_;
  std::int64_t began_ns_;
  std::int64_t now_ns_ = 0;
  std::optional<std::int64_t> world_start_ns_;  ///< its first opening
  bool has_power_ = true;
  double rate_hz_ = 0.0;
  double later_s_ = 0.0;
  std::int64_t boot_ns_ = 0;
  std::int64_t power_ns_ = 0;  ///< since when it has power
  std::uint64_t frames_ = 0;
  double watchdog_s_ = 0.0;
  std::int64_t fed_ns_ = 0;
  std::uint64_t said_ = 0;
  std::uint64_t left_out_ = 0;
  std::uint64_t trips_ = 0;  ///< of the watchdog
};

/// A haptic device of that name: `slider`, `woody-v4`, `2diy`, `hapkit`; nothing for another name.
/// @throws drivers::DeviceError for an option that there is not.
[[nodiscard]] std::unique_ptr<EmulatedOnLine> make_serial_device(drivers::Uri uri, std::vector<Fault> faults);

}  // namespace kerf::emulators

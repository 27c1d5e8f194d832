#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <kerf/drivers/protocols/c2000_image.h>
#include <kerf/drivers/protocols/falcon.h>
#include <kerf/drivers/uri.h>

#include "devices/ftdi.h"
#include "devices/held_tip.h"
#include "emulated_device.h"

namespace kerf::emulators {

/// A Novint Falcon (0403:cb48): its bridge, its boot loader, its firmware's answers, and its arms in a hand
/// that sways.
///
/// Without firmware it is silent but for the hello: 0A 43 0D at 9600 baud, after DTR has risen, is answered
/// 0A 44 2C 0D. Then an 'A' at 142 857 baud is sent back, and so is every byte after it, which are taken for
/// an image (c2000::Stream; any will do). When that is whole and the line runs at 1.5 Mbaud, each run-time
/// frame gets one reply 0.2 ms later. A hello takes the firmware away again; closing does not.
///
/// The motors are clamped to +-4096. Encoders count from where the knob stood at power-on until it is homed:
/// with the homing bit set the hand leads the knob out and in, and after `home_after` the three homed bits
/// come on and the counts are absolute. A frame without that bit ends the homing. The centre button is down
/// every other second.
///
/// Options: firmware=loaded|none (none), homed=on|off (off: it is not yet when plugged in), home_after
/// (0.3s), home_for (until then its homing is lost again; for good), offset (counts that stand for the
/// power-on place, 0), torque_scale (of the plant's motors, 10000 per N·m), sway (0.01m), hand=on|off (off:
/// the knob is moved by the motors alone, with mass, viscous, coulomb and delay as FreeTip has them),
/// glitch=on|off (off: a zero byte before the answer to the hello), trace=FILE (CSV, a line for each frame).
class EmulatedFalcon final : public EmulatedDevice {
 public:
  struct Options {
    bool loaded = false;
    bool homed = false;
    double home_after_s = 0.3;
    double home_for_s = -1.0;  ///< negative: until it is plugged in anew
    int offset = 0;
    double units_per_n_m = 10000.0;
    bool glitch = false;
    double sway_m = 0.01;
    std::optional<FreeTip::Options> free;  ///< nobody holds it
    std::string trace;
  };
  static Options parse_options(drivers::Uri uri);
  /// @throws drivers::DeviceError if the trace cannot be written.
  explicit EmulatedFalcon(const Options& options);

  [[nodiscard]] const Description& description() const override;
  std::optional<Bytes> control(const Setup& setup, std::span<const std::uint8_t> data,
                               std::int64_t now_ns) override;
  void receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, std::int64_t now_ns) override;
  std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                  std::int64_t waits_since_ns, std::int64_t now_ns,
                                  Disturbance& next) override;
  [[nodiscard]] std::optional<std::int64_t> next_event_ns(std::int64_t now_ns) const override;
  [[nodiscard]] std::size_t preamble() const override;
  void stick(bool stuck) override { stuck_ = stuck; }
  [[nodiscard]] std::string tell() const override;

 private:
  /// How far it is on the way from power-on to its firmware.
  enum class Boot : std::uint8_t { silent, listens, greeted, loading, running };

  void take_greeting(std::uint8_t byte, std::int64_t now_ns);
  void take_image(std::uint8_t byte, std::int64_t now_ns);
  void take_command(const drivers::falcon::Frame& frame, std::int64_t now_ns);
  void home(bool asked, double time_s);
  void turn_motors(const std::array<int, 3>& asked, double time_s);
  [[nodiscard]] std::array<int, 3> counts();
  [[nodiscard]] bool line_runs_at(double baud) const noexcept;
  [[nodiscard]] double seconds_at(std::int64_t now_ns) noexcept;

  Options options_;
  Ftdi bridge_;
  Boot boot_;
  std::string greeting_;  ///< the last bytes at 9600 baud
  drivers::c2000::Stream image_;
  std::int64_t echoed_ns_ = 0;

  drivers::falcon::FrameReader reader_;
  HeldTip tip_;
  std::array<int, 3> absolute_{};  ///< counts of the last place that the arms can reach
  std::array<int, 3> at_power_on_{};
  std::array<int, 3> motor_{};
  bool stuck_ = false;
  bool homed_;
  double homing_since_s_ = -1.0;
  std::int64_t start_ns_ = -1;
  std::uint64_t frames_ = 0;
  std::uint64_t clips_ = 0;
  std::ofstream trace_;
};

}  // namespace kerf::emulators

#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include <kerf/drivers/uri.h>

#include "emulated_device.h"
#include "report_wire.h"

namespace kerf::emulators {

/// A 3Dconnexion SpaceNavigator (046d:c626), its cap in a hand that sways along sines of 0.13 to 0.41 Hz and
/// presses button 1 every other second. One report each 8 ms, translation and rotation by turns, so that each
/// axis comes 62.5 times a second; at rest three pairs of zeros and then silence.
///
/// Options: amplitude (300 of the 350 that a cap gives), rest (0s: never; else it lets go after so long),
/// receiver=on|off (off: the same cap behind a Universal Receiver, 256f:c652, whose first interface is
/// another).
class EmulatedSpaceMouse final : public EmulatedDevice {
 public:
  struct Options {
    double amplitude = 300.0;
    double rest_s = 0.0;
    bool receiver = false;
  };
  static Options parse_options(drivers::Uri uri);
  explicit EmulatedSpaceMouse(const Options& options) : options_(options) {}

  [[nodiscard]] const Description& description() const override;
  std::optional<Bytes> control(const Setup& setup, std::span<const std::uint8_t> data,
                               std::int64_t now_ns) override;
  void receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, std::int64_t now_ns) override;
  std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                  std::int64_t waits_since_ns, std::int64_t now_ns,
                                  Disturbance& next) override;
  [[nodiscard]] std::optional<std::int64_t> next_event_ns(std::int64_t now_ns) const override;
  [[nodiscard]] std::string tell() const override;

 private:
  [[nodiscard]] Bytes next_report(double time_s);

  Options options_;
  std::int64_t start_ns_ = -1;
  std::int64_t due_ns_ = 0;
  std::uint64_t reports_ = 0;
  unsigned turn_ = 0;
  unsigned zeros_ = 0;
  bool pressed_ = false;
  bool lit_ = false;
  ReportWire wire_{0};  ///< the number of a report is what may be turned
};

}  // namespace kerf::emulators

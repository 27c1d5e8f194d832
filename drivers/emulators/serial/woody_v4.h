#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <kerf/mechanisms/woodenhaptics.h>

#include "serial/serial_device.h"

namespace kerf::emulators {

/// A WoodenHaptics of the fourth generation on a pseudo-terminal: its firmware from the facts of
/// forsslund/woodenhaptics, which answers each message and says nothing else; a tip of a woody-2016's arm.
///
/// What stands behind a message but line ends and zeros is error 8, a message without `[` 256, without two
/// commas 512, 127 letters without `]` 128, three numbers that are none 1024: it then answers with the last
/// counters and feeds no watchdog. More than 6000 mA on an axis is none. Without a good message for 100 ms
/// the currents are off.
///
/// Options: model (3), answer (0.1ms), button=2s (pressed then, the tip wherever it is: all counters are 0),
/// counter_offset (0, of each motor's), and those of every EmulatedSerialDevice. Faults: drop, corrupt,
/// split, duplicate, silence, restart, unplug.
class EmulatedWoodyV4 final : public EmulatedSerialDevice {
 public:
  struct Own {
    int model = 3;
    double answer_s = 1e-4;
    std::optional<double> button_s;
    int counter_offset = 0;
  };
  [[nodiscard]] static std::unique_ptr<EmulatedOnLine> make(drivers::UriOptions given,
                                                            std::vector<Fault> faults);
  EmulatedWoodyV4(const Options& options, const Own& own, std::vector<Fault> faults);

 private:
  void hear(std::span<const std::uint8_t> bytes) override;
  void moved() override;
  void let_go_by_watchdog() override;
  void begin_anew() override;
  void take_message(std::string_view text, bool has_more);
  void answer(int error);
  [[nodiscard]] Eigen::Vector3d force() const;
  [[nodiscard]] std::array<int, 3> raw_counts() const;

  Own own_;
  mechanisms::WoodenHaptics mechanism_;
  std::string heard_;
  std::array<int, 3> zero_{};  ///< counters where they were last zero
  std::array<int, 3> told_{};  ///< last
  std::array<int, 3> current_ma_{};
  bool was_pressed_ = false;
};

}  // namespace kerf::emulators

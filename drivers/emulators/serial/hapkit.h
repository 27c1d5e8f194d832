#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "serial/serial_device.h"

namespace kerf::emulators {

/// A Hapkit on a pseudo-terminal: a handle on a sector, a motor of which each duty makes a torque
/// T_ref (duty / 255)^2, a magnetic sensor whose ten bits begin anew after each of its half turns, and one of
/// two sketches, from firmware/hapkit/README.md and from the facts of bgromov/Hapkit3.0:
///
/// `firmware=kerf` sends frames at 1 kHz, takes orders, and lets go after 20 ms without one.
/// `firmware=stream` prints a line each thirtieth of its milliseconds, and pushes by no law.
///
/// Options: firmware (kerf), boot (1s; 1.4s of stream, which meanwhile would drive to its stops), begins
/// (400, where in its half turn the sensor is in the middle), noise (1, counts either way), flip (923, counts
/// of a half turn), motor (1; -1: its wires are the other way round), button (pressed from then on; of
/// stream), and those of every EmulatedSerialDevice. Faults: drop, corrupt, split, duplicate, silence,
/// restart, unplug.
class EmulatedHapkit final : public EmulatedSerialDevice {
 public:
  struct Own {
    bool prints = false;  ///< firmware=stream
    double boot_s = 1.0;
    double begins = 400.0;
    int noise = 1;
    double flip = 923.0;
    double motor = 1.0;
    std::optional<double> button_s;
  };
  [[nodiscard]] static std::unique_ptr<EmulatedOnLine> make(drivers::UriOptions given,
                                                            std::vector<Fault> faults);
  EmulatedHapkit(const Options& options, const Own& own, std::vector<Fault> faults);

 private:
  void hear(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] Bytes frame() override;
  void moved() override;
  void let_go_by_watchdog() override { duty_ = 0; }
  void begin_anew() override;
  /// What ten bits make of the angle now.
  [[nodiscard]] int sensor();
  [[nodiscard]] Bytes line();
  [[nodiscard]] Bytes binary_frame();
  /// @returns whether this value is a place
  bool count_half_turns(int value);

  Own own_;
  std::minstd_rand random_{1};
  // What a board has in its memory.
  std::uint16_t ticks_ = 0;
  Bytes heard_;
  bool has_refused_ = false;
  bool is_cut_ = false;
  std::optional<double> ordered_s_;  ///< when it last was
  std::uint8_t order_ = 0;
  int duty_ = 0;
  std::optional<int> place_;  ///< last value of the sensor that was one
  int values_since_ = 0;
  int flips_ = 0;
  // Of one that prints.
  bool has_printed_ = false;
  double speed_s_ = 0.0;  ///< when speed was taken last
  double speed_from_m_ = 0.0;
  double speed_m_s_ = 0.0;
  double acceleration_m_s2_ = 0.0;
};

}  // namespace kerf::emulators

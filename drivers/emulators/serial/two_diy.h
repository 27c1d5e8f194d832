#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <kerf/drivers/protocols/two_diy.h>
#include <kerf/mechanisms/pantograph.h>

#include "serial/serial_device.h"

namespace kerf::emulators {

/// A Haply 2DIY on a pseudo-terminal: its board from the facts of the firmware, which reads byte by byte,
/// answers torques alone, knows no time and holds the last torque for ever. The arms rest; within the second
/// after the first opening a hand lifts the handle into the middle.
///
/// Options: version (v3.1), and those of every EmulatedSerialDevice. Faults: drop, corrupt, duplicate,
/// silence, restart, unplug.
class EmulatedTwoDiy final : public EmulatedSerialDevice {
 public:
  [[nodiscard]] static std::unique_ptr<EmulatedOnLine> make(drivers::UriOptions given,
                                                            std::vector<Fault> faults);
  EmulatedTwoDiy(const Options& options, const drivers::two_diy::Version& version, std::vector<Fault> faults);

 private:
  /// What the board was told of one port.
  struct Port {
    double direction = 1.0;
    double offset_deg = 0.0;
    double counts = 1.0;
    double zero_deg = 0.0;  ///< true angle where it was set up
  };
  void hear(std::span<const std::uint8_t> bytes) override;
  void moved() override;
  void begin_anew() override;
  void forget();
  [[nodiscard]] bool take_message();
  void answer();
  [[nodiscard]] Eigen::Vector2d angles_deg() const;
  [[nodiscard]] Eigen::Vector3d force() const;

  drivers::two_diy::Version version_;
  mechanisms::Pantograph mechanism_;
  std::vector<std::uint8_t> heard_;
  std::array<Port, 2> ports_{};
  std::array<double, 2> torque_n_m_{};  ///< by port
  bool is_set_up_ = false;
};

}  // namespace kerf::emulators

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <kerf/drivers/device.h>

#include "loop/command.h"
#include "replay/path.h"

namespace kerf::bench {

/// A spring and a damper between a device and where it should be.
struct Coupling {
  double stiffness = 0.0;    ///< K [unit of force per unit of position]
  double damping = 0.0;      ///< B [unit of force per unit of velocity]
  double force_limit = 0.0;  ///< in the unit of force
};

/// Settings of the coupling; what is not said keeps its default. Stiffness and damping are at the lever
/// for an axis in N (N/m, N·s/m), about the axis for one in N·m (N·m/rad, N·m·s/rad).
struct CouplingOptions {
  using PerAxis = std::vector<std::string>;  ///< "VALUE" for every axis, or "AXIS=VALUE"
  PerAxis stiffness;
  PerAxis damping;
  PerAxis force_limit;
};

/// The coupling of each axis of a device. By default that of a hand's usual grip (500 N/m, 5 N·s/m, or
/// 1 N·m/rad, 0.02 N·m·s/rad), within half of what the axis may exert and 5 N or 0.5 N·m.
/// @throws std::invalid_argument for text that is no number, an axis that is not there, a value below zero,
///         or a force beyond the device's limit.
[[nodiscard]] std::array<Coupling, drivers::max_axes> couplings(const CouplingOptions& options,
                                                                const drivers::DeviceInfo& device);

/// How well a device was held to a path, by axis of the device.
struct PathReport {
  struct Axis {
    double squares = 0.0;  ///< of reference less position, while the recording itself was played
    double worst = 0.0;
    double largest_step = 0.0;  ///< of the reference in one tick, anywhere
    std::uint64_t limited = 0;  ///< ticks in which the coupling's force limit held
  };
  std::array<Axis, drivers::max_axes> axes;
  std::uint64_t playing = 0;  ///< ticks
  bool finished = false;      ///< the path was played to its end

  /// Root mean square of reference less position along an axis of the device.
  [[nodiscard]] double error_rms(std::size_t axis) const noexcept;
};

/// Holds a device to a path by a virtual coupling:
///
///     F = g clamp(K (x_r - x) + B (v_r - v), +- limit),   on each axis of the path
///
/// with the reference x_r, v_r of a PathPlayer. At the path's end g fades from 1 to 0 over `fade_s`, and then
/// the rendering has finished. The force at its beginning is that of the damper alone, since the reference
/// begins where the device is. The path waits while the loop stalls or zero force is held for longer than 10
/// ms.
class PathRendering {
 public:
  PathRendering(const Path& path, const std::array<Coupling, drivers::max_axes>& coupling, double fade_s,
                PathReport& report) noexcept
      : path_(&path), player_(path), coupling_(coupling), fade_s_(fade_s), report_(&report) {}

  [[nodiscard]] Command operator()(const drivers::Sample& sample, double elapsed_s) noexcept;
  [[nodiscard]] bool finished() const noexcept { return report_->finished; }

 private:
  void count(const Reference& reference, const drivers::Sample& sample) noexcept;

  const Path* path_;
  PathPlayer player_;
  std::array<Coupling, drivers::max_axes> coupling_;
  double fade_s_;
  double faded_s_ = 0.0;
  PathReport* report_;
  drivers::Axes last_{};
  bool started_ = false;
};

}  // namespace kerf::bench

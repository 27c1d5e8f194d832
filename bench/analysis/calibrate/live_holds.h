#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "calibrate/loads_script.h"
#include "calibrate/measured_holds.h"

namespace kerf::bench {

struct LiveHoldsOptions {
  std::string uri;
  std::optional<double> hands_free_s;  ///< wait so long in place of Enter
  double settle_timeout_s = 30.0;
  std::uint64_t seed = 1;  ///< of a simulated sensor: by how much the loads are wrong
  /// Says what is to be put on.
  std::function<void(std::string_view line)> say;
  /// Waits until a person has done so; false: nobody will.
  std::function<bool()> wait;
};

/// What came of it.
struct LiveHolds {
  MeasuredHolds measured;
  bool finished = false;                 ///< all steps; else it was stopped
  std::string problem;                   ///< why not, where it was the sensor; empty otherwise
  std::optional<std::uint32_t> labjack;  ///< its serial number
  double range_v = 10.0;
  /// Of a simulated sensor, as JSON: the matrix, C, and what else was drawn. Empty of others.
  std::string truth;
};

/// Opens a sensor and measures the steps of a script that are not in `before`, one after the other: waits for
/// the person, until the signals are steady, and takes the mean of the hold. Steady is where the means of the
/// two halves of half a second differ by no more than four standard errors of their noise, for every signal.
/// A simulated sensor is loaded by itself, in virtual time, by loads that are wrong as the script says they
/// may be.
/// @throws drivers::DeviceError; std::invalid_argument for a device without signals.
[[nodiscard]] LiveHolds measure_holds(const LoadScript& script, const LiveHoldsOptions& options,
                                      const MeasuredHolds& before, const std::atomic<bool>& stop);

}  // namespace kerf::bench

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "calibrate/loads_script.h"

namespace kerf::bench {

/// What a sensor said under one load that stood still.
struct MeasuredHold {
  std::size_t row = 0;   ///< first row or line of it in its table; of a script the step's number
  std::size_t step = 0;  ///< of the script, from 1; 0: of none
  Wrench load = Wrench::Zero();
  double time_s = 0.0;
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< [degC]
  std::vector<double> signal;                                     ///< means
  std::vector<double> noise;  ///< of one reading, standard deviation; NaN: not known
  std::size_t readings = 1;
  bool settled = true;
};

/// Where the numbers of a calibration come from.
struct MeasuredHolds {
  std::string source;                   ///< file or URI
  std::vector<std::string> signals;     ///< names
  std::vector<std::size_t> components;  ///< of the wrench, those that any load was said of
  std::vector<double> quantum;          ///< of each signal; 0: none is seen
  std::vector<MeasuredHold> holds;
  bool has_time = false;
};

/// Reads a table (CSV and its like) or a recording (its channels) of signals and loads. `map` says which
/// column is what: fx, fy, fz, tx, ty, tz (loads), time, temperature, step, hold; each other name is a
/// signal. Without a map the columns are taken by these names, and `signal_...` and `u...` as signals.
/// Neighbouring rows of the same load (and hold) are one hold.
/// @throws std::invalid_argument in one line, with the line of what is no number.
[[nodiscard]] MeasuredHolds read_measured_holds(const std::string& file, const std::string& map);

/// Takes the loads of a script by their step. @throws std::invalid_argument for a table without steps.
void take_loads(MeasuredHolds& measured, const LoadScript& script);

/// As a table that read_measured_holds() reads again.
[[nodiscard]] std::string holds_as_csv(const MeasuredHolds& measured);

inline constexpr std::array<std::string_view, 6> wrench_components{"fx", "fy", "fz", "tx", "ty", "tz"};

}  // namespace kerf::bench

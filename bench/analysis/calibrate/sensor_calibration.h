#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "calibrate/loads_script.h"
#include "calibrate/measured_holds.h"

namespace kerf::bench {

struct SensorCalibrationOptions {
  std::vector<std::size_t> components;  ///< of the wrench; empty: those that are there
  double tolerance = 0.0;  ///< of the loads of a table, in shares of each, as limits; a script has its own
  std::vector<std::size_t> leave_out;  ///< rows (of a script: steps)
  double range = 0.0;                  ///< at which a signal ends; 0: not known
  bool keep_misfits = false;           ///< warn of loads that contradict the others instead of refusing
  std::chrono::year_month_day date{};  ///< of the calibration
  std::string serial_number;           ///< of the transducer; empty: not known
  std::string provenance;
  std::optional<std::uint32_t> labjack;
  double stale_after_days = 365.0;
};

/// A calibration with all that is written of it.
// NOLINTNEXTLINE(bugprone-exception-escape): of what moves JSON, which does not throw
struct SensorCalibrationFiles {
  nlohmann::ordered_json json;
  std::string toml;       ///< as drivers::read_force_calibration() reads it; empty: more than six signals
  std::string residuals;  ///< CSV: a hold a line
  std::vector<std::string> lines;
  std::vector<std::string> warnings;
};

/// `script` of measured holds that have steps; nullptr: the loads are those of the table.
/// @throws std::invalid_argument in one line for loads or signals that no matrix can be made of.
[[nodiscard]] SensorCalibrationFiles calibrate_sensor(MeasuredHolds measured, const LoadScript* script,
                                                      const SensorCalibrationOptions& options);

}  // namespace kerf::bench

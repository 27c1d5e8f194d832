#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/fitting/calibration/calibration.h>
#include <kerf/fitting/calibration/load_checks.h>

#include "calibrate/loads_script.h"
#include "calibrate/measured_holds.h"
#include "calibrate/sensor_calibration.h"

namespace kerf::bench {

/// Measured holds as the fit takes them: without those to leave out, those that never became steady and
/// copies, with what the loads may be wrong by.
class PreparedHolds {
 public:
  /// What is left out is taken from `measured` too, and said in `warnings`.
  PreparedHolds(MeasuredHolds& measured, const LoadScript* script, const SensorCalibrationOptions& options,
                std::vector<std::string>& warnings);

  [[nodiscard]] const fitting::calibration::Holds& holds() const { return holds_; }
  [[nodiscard]] const std::vector<std::size_t>& components() const { return components_; }

  /// Six ways and the levers that there were, at the largest loads that there were.
  [[nodiscard]] std::vector<fitting::calibration::Candidate> candidates() const;

 private:
  void leave_out();
  [[nodiscard]] fitting::calibration::Holds as_holds() const;
  void take_copies_out();
  void take_errors();

  MeasuredHolds& measured_;
  const LoadScript* script_;
  const SensorCalibrationOptions& options_;
  std::vector<std::string>& warnings_;
  std::vector<std::size_t> components_;
  fitting::calibration::Holds holds_;
};

}  // namespace kerf::bench

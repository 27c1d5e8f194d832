#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace kerf::fitting::calibration {

/// A sensor under one load that stands still: the means of its signals. Samples within a hold are correlated
/// (creep, friction, the hand that put the weight on), so that a hold is one observation, however long.
struct Hold {
  std::vector<double> load;    ///< f [N, N·m], one number a component
  std::vector<double> signal;  ///< y, in the signals' unit, one number a signal
  double time_s = 0.0;
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< [degC]; NaN: not measured
  std::size_t load_number = 0;  ///< holds of the same load have the same: they are left out together
  std::size_t placement = 0;    ///< holds with the same direction and point have the same
  std::size_t tare = 0;         ///< holds with the same reading without load have the same, from 0
  std::size_t row = 0;          ///< of the table or the script, for messages
};

/// What a calibration is made of, in the order in which it was measured.
struct Holds {
  std::vector<std::string> components;  ///< "fx", ..., names of the loads' numbers
  std::vector<std::string> signals;     ///< names of the signals
  std::vector<Hold> holds;
  /// G: what is not known of the loads, of independent sources with standard deviation 1. Row
  /// `hold * components + component`, a column a source: the mass of a piece, a direction, a lever, gravity.
  /// A source that several holds share is one column. No columns: the loads are known exactly.
  Eigen::MatrixXd load_error;
};

}  // namespace kerf::fitting::calibration

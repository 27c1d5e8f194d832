#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <kerf/fitting/calibration/calibration.h>

namespace kerf::fitting::calibration {

/// The columns that every signal has: loads in shares of their full scale, one column of ones a tare, time
/// over its span (0 at the end), temperature over its range (0 in the mean).
struct Design {
  Eigen::MatrixXd columns;
  Eigen::VectorXd full_scale;  ///< of each component; 1 where no load is along it
  Eigen::Index tares = 0;
  Eigen::Index drift = -1;        ///< its column; -1: none
  Eigen::Index temperature = -1;  ///< its column; -1: none
  double time_span_s = 0.0;
  double temperature_range_k = 0.0;
  double mean_temperature = 0.0;
  bool has_temperature = false;  ///< measured in every hold

  [[nodiscard]] Eigen::Index components() const noexcept { return full_scale.size(); }
};

/// @throws std::invalid_argument for holds of different sizes and numbers that are not finite.
void require_sound(const Holds& holds);
[[nodiscard]] Design design_of(const Holds& holds, const Options& options);

/// The loads' columns with all others projected out, and their singular values.
[[nodiscard]] Eigen::MatrixXd loads_alone(const Design& design);

/// Loads as a matrix, holds x components.
[[nodiscard]] Eigen::MatrixXd loads_of(const Holds& holds);
/// Means of a signal.
[[nodiscard]] Eigen::VectorXd signal_of(const Holds& holds, std::size_t signal);

/// How a signal with hysteresis follows its loads: the play operator, linear as long as it drags where it
/// does.
///
///     follower = min(max(follower before, elastic - r), elastic + r),   elastic = loads a
///
/// Where it drags it is elastic +- r, where it sticks what it was: `loads` a + `width` r, row by row.
struct Branch {
  Eigen::MatrixXd loads;              ///< of the hold where it dragged last
  Eigen::VectorXd width;              ///< -1 rising, +1 falling, 0 before the first load
  std::vector<Eigen::Index> dragged;  ///< that hold
};
[[nodiscard]] Branch branch_of(const Eigen::MatrixXd& loads, const Eigen::VectorXd& coefficients,
                               double half_width);

}  // namespace kerf::fitting::calibration

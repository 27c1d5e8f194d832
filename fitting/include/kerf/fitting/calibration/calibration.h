#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <kerf/fitting/calibration/holds.h>

namespace kerf::fitting::calibration {

/// A number and the half of its interval.
struct Estimate {
  double value = 0.0;
  double half_width = 0.0;
};

struct Options {
  double confidence = 0.95;  ///< of the intervals, between 0 and 1
  bool drift = true;         ///< d is estimated where the holds take any time
  bool hysteresis = true;    ///< r is estimated where loads rise and fall
  /// c is estimated where the temperature varies by at least so much [K].
  double least_temperature_range_k = 1.0;
};

/// What is known of one signal, in its unit.
struct SignalEstimate {
  double repeatability = 0.0;           ///< sigma: standard deviation of a hold's mean, loads' errors apart
  double degrees_of_freedom = 0.0;      ///< of sigma
  std::optional<Estimate> drift_per_s;  ///< d
  std::optional<Estimate> per_kelvin;   ///< c
  std::optional<Estimate> hysteresis_width;  ///< r: half of the distance between rising and falling
};

/// What is known of one component of force, in N or N·m.
struct ComponentEstimate {
  double full_scale = 0.0;  ///< largest load along it, its size
  /// Half of the interval of the force that is told under the full load of this component alone, systematic:
  /// it does not become smaller by averaging readings.
  double half_width_at_full_scale = 0.0;
  double largest_half_width = 0.0;  ///< of this component over all loads that were put on
  std::optional<Estimate> drift_per_min;
  std::optional<Estimate> hysteresis_percent;  ///< of full scale: falling less rising, at the same load
  double left_out_rms = 0.0;      ///< error of each load told by a calibration that did not see it
  double left_out_largest = 0.0;  ///< its size
};

/// The calibration of a force sensor with N signals and m <= N components:
///
///     y = P_r[A f] + u_0 + d (t - t_end) + c (T - T_0) + e
///
/// y the mean signals of a hold, f its load, A [N x m] the sensitivity with cross-talk, u_0 the signals
/// without load at the end, d drift, c temperature coefficient, T_0 the mean temperature. P_r is the play
/// operator with half width r: once the load has gone 2 r it follows A f at a distance, A f - r while it
/// rises and A f + r while it falls; in between it sticks. e has standard deviation sigma from hold to hold.
/// The loads differ from what is given by G w (Holds::load_error), w normal with deviation 1.
///
/// Each signal is fitted by generalised least squares with the covariance sigma² I + (A G)(A G)^T, where
/// sigma² is that of the largest restricted likelihood [PattersonThompson1971]. Then
///
///     f = C (y - u_0),   C = (A^T W A)^-1 A^T W,   W = diag(1 / sigma²);   C = A^-1 where N = m
///
/// The covariance of C is that of A through dC = -C dA C + (A^T W A)^-1 dA^T W (I - A C), errors that signals
/// share included; intervals are Student's, with Satterthwaite's degrees of freedom of sigma² in each number.
struct SensorCalibration {
  Eigen::MatrixXd sensitivity;             ///< A
  Eigen::MatrixXd sensitivity_half_width;  ///< of each of its elements
  Eigen::MatrixXd matrix;                  ///< C
  Eigen::MatrixXd matrix_half_width;       ///< of each of its elements
  Eigen::VectorXd bias;                    ///< u_0, mean over the tares
  Eigen::VectorXd bias_half_width;
  std::optional<double> temperature;  ///< T_0 [degC], if any was measured
  std::vector<SignalEstimate> signals;
  std::vector<ComponentEstimate> components;
  Eigen::MatrixXd residuals;  ///< told less given load, holds x components; hysteresis is not taken out
  Eigen::MatrixXd left_out;   ///< the same by a calibration without the holds of that load
  /// Of the loads, each in shares of its full scale, after tare, drift and temperature are taken out.
  double condition = 0.0;
};

/// @throws std::invalid_argument in one line: no holds, sizes that differ, numbers that are not finite, fewer
///         holds than unknowns, or loads that cannot determine the matrix (what is missing is named).
[[nodiscard]] SensorCalibration calibrate(const Holds& holds, const Options& options = {});

}  // namespace kerf::fitting::calibration

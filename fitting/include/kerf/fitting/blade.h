#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <kerf/fitting/fit.h>
#include <kerf/models/law.h>

namespace kerf::fitting {

/// The samples of a tool with six axes, as a recording has them: x, y, z [m] of the hand point and rx, ry, rz
/// the rotation vector of the tool's frame [rad]. N x 6, row by row; the tissue is z < 0.
struct BladeSeries {
  std::span<const double> time_s;    ///< N, increasing
  std::span<const double> position;  ///< N x 6
  std::span<const double> velocity;  ///< N x 6, its derivative without a lag
  std::span<const double> force;     ///< N x 6, what the tissue exerts: N, and the torques of the axes [N·m]
};

/// How the force peaks are found.
struct PeakOptions {
  double window_s = 0.01;   ///< a line is fitted to so much before a drop, and after it
  double prominence = 8.0;  ///< a drop counts from so many times its own standard error
};

struct BladeFitOptions {
  models::Options law_options;  ///< polygons, edge, fidelity, strips; `thresholds` is set by the fit
  bool thresholds = false;      ///< also the elastic field, F0 and F1
  /// Standard deviation of the noise of each axis [N, N·m]: zero is estimated from the residuals, an infinite
  /// one leaves the axis out of the fit, whatever numbers it has.
  std::array<double, 6> noise{};
  bool robust = false;  ///< Huber's loss in place of squares
  double confidence = 0.95;
  PeakOptions peaks;
};

/// A threshold of force, from the events at which it was crossed.
struct ThresholdEvents {
  std::vector<double> force_n;  ///< |F| just before each event [N]
  double spread_n = 0.0;        ///< standard deviation from one event to another [N]
};

/// What the two thresholds and the elastic field were found from.
struct BladePhases {
  std::size_t elastic_rows = 0;
  std::size_t cutting_rows = 0;
  ThresholdEvents ruptures;  ///< elastic to cutting: F1
  ThresholdEvents releases;  ///< cutting to elastic: F0
  std::size_t iterations = 0;
  bool settled = true;
  double agreement = 0.0;  ///< share of those rows on which the law as fitted is in the same phase
};

struct BladeFit {
  models::Options law_options;
  std::vector<Estimate> parameters;  ///< those of the law `blade`, in its order
  Eigen::MatrixXd correlation;       ///< of the estimates; NaN where the data determine none
  std::size_t rows = 0;
  std::size_t rows_in_tissue = 0;
  std::array<double, 6> rmse{};              ///< in the tissue, a fit's own phases [N, N·m]
  std::array<double, 6> rmse_rendered{};     ///< in the tissue, the law stepped along the whole series
  std::array<double, 6> rms{};               ///< of the force itself
  std::array<double, 6> noise{};             ///< the standard deviations that weighted the axes
  std::array<double, 6> correlation_time{};  ///< of the residuals [samples]
  BladePhases phases;                        ///< only with thresholds
  std::vector<std::string> warnings;

  [[nodiscard]] models::Law law() const;
};

/// Fits the law `blade` to six-axis data:
///
///     f_i = Kv e_i + Kn n_i + Kt t_i + noise
///
/// where the columns e_i, n_i, t_i are blade_wrench() of unit fields at pose and twist i, so that the law
/// that is fitted is the law that is rendered. Least squares over all axes, each divided by its noise
/// (estimated in a pass before), with no parameter below zero. Intervals as in fit(): Student's t on the
/// larger of the error by the residuals' correlation time, axis by axis, and the jackknife over 20 stretches
/// of time.
///
/// With thresholds, drops of the force divide the time in the tissue into phases. A phase that begins without
/// force, or in the surface, holds elastically; another cuts. Both fields are fitted to their phases, each
/// phase goes to the field that explains it better, and so on until nothing changes. Where the tissue began
/// to hold is known to a sample only, so that an elastic phase has a shift of its anchor of its own. F1 and
/// F0 are the means of the force just before the ruptures and the releases; below 3 events their intervals
/// are infinite.
/// @throws std::invalid_argument if the series cannot be fitted at all: lengths, numbers that are not finite,
///         time that does not increase, a blade that never touches the tissue, an option of the law.
[[nodiscard]] BladeFit fit_blade(const BladeSeries& series, const BladeFitOptions& options = {});

}  // namespace kerf::fitting

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law.h>

namespace kerf::fitting {

/// The samples of one recording as a law sees them. All spans have one length.
struct Series {
  std::span<const double> time_s;        ///< increasing
  std::span<const double> penetration;   ///< x, in the tool's direction of engagement [m or rad]
  std::span<const double> velocity;      ///< dx/dt
  std::span<const double> force;         ///< resisting force [N]
  std::span<const std::uint32_t> cycle;  ///< cycle of each sample, 0 for none; empty if not segmented
};

/// What a person can feel: the larger of a Weber fraction of the force and an absolute threshold.
/// Source of the defaults: Pang, Tan and Durlach 1991 (7 %); order of magnitude at the fingertips (0.05 N).
struct ForceJnd {
  double weber_fraction = 0.07;
  double threshold_n = 0.05;
  [[nodiscard]] double at(double force_n) const noexcept;
};

struct FitOptions {
  models::Options
      law_options;  ///< integrator, thickness, segments, points, loop, ...; the rest from the data
  ForceJnd jnd;
  std::size_t folds =
      5;  ///< of the cross-validation: by cycle, or by blocks of time where there are no cycles
  double confidence = 0.95;  ///< of the intervals
};

/// A parameter with its uncertainty. A parameter that was not searched (the ends of a piecewise law's knots)
/// has a standard error of zero; one that the data do not determine has infinite ones.
struct Estimate {
  models::ParameterInfo info;
  double value = 0.0;
  double std_error = 0.0;
  double lower = 0.0;  ///< confidence interval
  double upper = 0.0;
};

struct FitResult {
  std::string model;
  models::Options law_options;
  std::vector<Estimate> parameters;
  std::size_t free_parameters = 0;
  double rmse = 0.0;     ///< [N]
  double max_abs = 0.0;  ///< [N]
  double r2 = 0.0;
  double aic = 0.0;               ///< n ln(RSS/n) + 2 (p + 1)
  double bic = 0.0;               ///< n ln(RSS/n) + (p + 1) ln n
  double cv_rmse = 0.0;           ///< on held-out cycles [N]
  double jnd_fraction = 0.0;      ///< share of samples whose error a person could feel
  double correlation_time = 1.0;  ///< of the residuals, in samples; the intervals allow for it
  bool converged = false;
  int iterations = 0;
  double seconds = 0.0;
  std::string message;  ///< why it ended
  std::vector<std::string> warnings;

  [[nodiscard]] models::Law law() const;
};

/// The laws that can be fitted to a series.
[[nodiscard]] const std::vector<std::string_view>& fitted_laws();
/// @throws std::invalid_argument for an unknown law, or one that is not among fitted_laws().
void check_model(std::string_view model);

/// Fits one law of the registry by least squares on the law's own step.
///
/// Kelvin, exponential and precontact: a scan over the one nonlinear parameter gives three starts, and the
/// best of the three solutions is kept. Analytical scissors: linear in all parameters, which gives the start.
/// Piecewise: dynamic programming over a grid gives the breakpoints, which are then polished together with
/// the forces under continuity. Recording: linear least squares on the table's own interpolation. Laws with
/// two branches are fitted to cycles as loops, and are judged without their rendering aids.
///
/// Intervals are Student's t on the larger of two variances: that of s^2 tau (J^T J)^-1, where tau is the
/// integrated autocorrelation time of the residuals (Sokal's window), so that n / tau samples count; and that
/// of the jackknife over 20 stretches of time, which also sees errors that last while the tool stands still,
/// such as encoder steps. Logarithmic parameters get their interval on the log scale. Non-convergence is a
/// value of the result.
/// @throws std::invalid_argument for an unknown law or option, or a series that cannot be fitted at all
/// (fewer samples
///         than parameters, constant position, samples that are not finite), saying which.
[[nodiscard]] FitResult fit(std::string_view model, const Series& series, const FitOptions& options = {});

/// Root mean square error of the straight line of force over penetration: what any law has to beat [N].
[[nodiscard]] double line_rmse(const Series& series);

/// Which law to take, and why.
struct Choice {
  std::string model;
  std::string why;
};

/// The law with fewest parameters whose error on held-out cycles stays within the JND at the recording's own
/// force (root mean square), or within 5 % of the best; where none is within the JND, the reason says so.
[[nodiscard]] Choice choose_simplest(std::span<const FitResult> results, const Series& series,
                                     const ForceJnd& jnd);

}  // namespace kerf::fitting

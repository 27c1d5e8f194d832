#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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
  models::Options law_options;  ///< integrator, thickness, segments, ...
  ForceJnd jnd;
  std::size_t folds = 5;  ///< of the cross-validation, by cycle, or by blocks of time without cycles
  double confidence = 0.95;
};

/// A parameter with its uncertainty.
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
  double rmse = 0.0;     ///< [N]
  double max_abs = 0.0;  ///< [N]
  double r2 = 0.0;
  double aic = 0.0;
  double bic = 0.0;
  double cv_rmse = 0.0;       ///< on held-out cycles [N]
  double jnd_fraction = 0.0;  ///< share of samples whose error a person could feel
  bool converged = false;
  int iterations = 0;
  double seconds = 0.0;
  std::string message;  ///< why it ended
  std::vector<std::string> warnings;

  [[nodiscard]] models::Law law() const;
};

/// Fits one law. Non-convergence is a value of the result.
/// @throws std::invalid_argument for an unknown law or option, or a series that cannot be fitted at all
///         (fewer samples than parameters, constant position, non-finite samples), saying which.
[[nodiscard]] FitResult fit(std::string_view model, const Series& series, const FitOptions& options = {});

}  // namespace kerf::fitting

#include "kerf/fitting/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "least_squares.h"
#include "samples.h"
#include "search.h"
#include "statistics.h"

namespace kerf::fitting {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<double> residuals_of(const models::Law& law, const Samples& samples) {
  std::vector<double> residuals = rendered(law, samples);
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] -= samples.force[i];
  return residuals;
}

double sum_of_squares(const std::vector<double>& values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

void measure_errors(FitResult& result, const std::vector<double>& residuals, const Samples& samples,
                    const ForceJnd& jnd) {
  const auto n = static_cast<double>(samples.size());
  const double squares = sum_of_squares(residuals);
  const double mean = std::accumulate(samples.force.begin(), samples.force.end(), 0.0) / n;
  double total = 0.0;
  std::size_t felt = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    total += (samples.force[i] - mean) * (samples.force[i] - mean);
    result.max_abs = std::max(result.max_abs, std::abs(residuals[i]));
    felt += std::abs(residuals[i]) > jnd.at(samples.force[i]) ? 1 : 0;
  }
  result.rmse = std::sqrt(squares / n);
  result.r2 = total > 0.0 ? 1.0 - squares / total : 0.0;
  result.jnd_fraction = static_cast<double>(felt) / n;
  const double likelihood = n * std::log(std::max(squares / n, std::numeric_limits<double>::min()));
  const auto p = static_cast<double>(result.free_parameters + 1);  // the noise is one more
  result.aic = likelihood + 2.0 * p;
  result.bic = likelihood + p * std::log(n);
}

/// Inverse of J^T J, with the directions that the data do not determine left out and told of.
struct Inverse {
  Eigen::MatrixXd matrix;
  std::vector<bool> undetermined;
};

Inverse inverse_of(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd diagonal = normal.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = (diagonal.array() > 0.0).select(diagonal.cwiseInverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(scale.asDiagonal() * normal *
                                                                scale.asDiagonal());
  const double threshold = 1e-12 * spectrum.eigenvalues().maxCoeff();
  const Eigen::VectorXd inverted =
      (spectrum.eigenvalues().array() > threshold).select(spectrum.eigenvalues().cwiseInverse(), 0.0);
  const Eigen::MatrixXd basis = scale.asDiagonal() * spectrum.eigenvectors();
  Inverse inverse{.matrix = basis * inverted.asDiagonal() * basis.transpose(), .undetermined = {}};
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    double lost = 0.0;
    for (Eigen::Index j = 0; j < scale.size(); ++j) {
      if (spectrum.eigenvalues()[j] <= threshold) lost += std::pow(spectrum.eigenvectors()(k, j), 2);
    }
    inverse.undetermined.push_back(lost > 1e-6 || scale[k] == 0.0);
  }
  return inverse;
}

/// Half the width of each free parameter's interval is `quantile * deviation`, on its search scale.
struct Spread {
  double deviation;
  double quantile;
};

/// Standard deviations by the delete-a-group jackknife, one Newton step for each stretch of time that is left
/// out.
Eigen::VectorXd jackknife(const Solution& solution) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(solution.normal.rows());
  for (const Stretch& stretch : solution.stretches) {
    const Eigen::VectorXd shift = inverse_of(solution.normal - stretch.normal).matrix * stretch.score;
    squares += shift.cwiseAbs2();
  }
  const auto groups = static_cast<double>(stretch_count);
  return ((groups - 1.0) / groups * squares).cwiseSqrt();
}

/// The larger of two deviations: that of the residuals, stretched by their correlation time, and the
/// jackknife's, which also sees errors that stay while the tool stands still (encoder steps).
std::vector<Spread> spreads(const Solution& solution, double noise_variance, double effective_samples,
                            double confidence) {
  const Inverse inverse = inverse_of(solution.normal);
  const Eigen::VectorXd by_groups = jackknife(solution);
  const double t_of_samples =
      student_t(confidence, effective_samples - static_cast<double>(solution.normal.rows()));
  const double t_of_groups = student_t(confidence, static_cast<double>(stretch_count) - 1.0);
  std::vector<Spread> all;
  for (Eigen::Index k = 0; k < solution.normal.rows(); ++k) {
    if (inverse.undetermined[static_cast<std::size_t>(k)]) {
      all.push_back({.deviation = infinite, .quantile = t_of_samples});
      continue;
    }
    const double by_samples = std::sqrt(noise_variance * inverse.matrix(k, k));
    all.push_back(by_samples >= by_groups[k] ? Spread{by_samples, t_of_samples}
                                             : Spread{by_groups[k], t_of_groups});
  }
  return all;
}

void estimate_parameters(FitResult& result, const Problem& problem, const Solution& solution,
                         const std::vector<double>& residuals, double confidence) {
  const auto n = static_cast<double>(residuals.size());
  const auto p = static_cast<double>(problem.free_count());
  result.correlation_time = correlation_time(residuals);
  const double noise_variance = sum_of_squares(residuals) / std::max(1.0, n - p) * result.correlation_time;
  const auto searched = spreads(solution, noise_variance, n / result.correlation_time, confidence);
  auto next = searched.begin();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const models::ParameterInfo& info = problem.parameters[i];
    Estimate estimate{.info = info, .value = solution.values[i]};
    const Spread spread = problem.free[i] ? *next++ : Spread{0.0, 0.0};
    const bool logarithmic = info.scale == models::Scale::logarithmic;
    const double centre = to_search_scale(info, estimate.value);
    estimate.std_error = logarithmic ? estimate.value * spread.deviation : spread.deviation;
    estimate.lower = from_search_scale(info, centre - spread.quantile * spread.deviation);
    estimate.upper = from_search_scale(info, centre + spread.quantile * spread.deviation);
    if (!std::isfinite(spread.deviation)) {
      result.warnings.push_back("the data do not determine '" + info.name + "'");
    } else if (problem.free[i] && (estimate.value <= info.lower * (info.lower > 0.0 ? 1.001 : 1.0) ||
                                   estimate.value >= info.upper)) {
      result.warnings.push_back("'" + info.name + "' lies at the bound of its range");
    }
    result.parameters.push_back(std::move(estimate));
  }
}

/// Error on samples that the fit has not seen; infinite if a fold could not be fitted.
double cross_validate(const Problem& problem, const Samples& samples, const std::vector<double>& near) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t fold = 0; fold < samples.folds; ++fold) {
    const Mask mask = without_fold(samples, fold);
    const Solution solution = search(problem, samples, mask, near);
    if (solution.values.empty()) return infinite;
    const auto residuals =
        residuals_of(models::Law::make(problem.model, solution.values, problem.law_options), samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (mask[i]) continue;
      squares += residuals[i] * residuals[i];
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : infinite;
}

}  // namespace

double ForceJnd::at(double force_n) const noexcept {
  return std::max(weber_fraction * std::abs(force_n), threshold_n);
}

models::Law FitResult::law() const {
  std::vector<double> values;
  for (const Estimate& estimate : parameters) values.push_back(estimate.value);
  return models::Law::make(model, values, law_options);
}

const std::vector<std::string_view>& fitted_laws() {
  static const std::vector<std::string_view> laws{"kelvin",    "exponential",       "piecewise",
                                                  "recording", "scissors_analytic", "precontact"};
  return laws;
}

void check_model(std::string_view model) {
  (void)models::Law::options(model);  // an unknown law is told as such
  if (std::find(fitted_laws().begin(), fitted_laws().end(), model) != fitted_laws().end()) return;
  std::string message =
      "law '" + std::string(model) + "' cannot be fitted to a recording; those that can are";
  for (const std::string_view law : fitted_laws()) {
    message += (law == fitted_laws().front() ? " " : ", ") + std::string(law);
  }
  throw std::invalid_argument(message);
}

FitResult fit(std::string_view model, const Series& series, const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Samples samples = check_series(series, options.folds);
  const Problem problem = make_problem(model, options.law_options, samples);
  FitResult result{.model = std::string(model), .law_options = problem.law_options};
  result.free_parameters = problem.free_count();
  if (samples.size() <= result.free_parameters) {
    std::ostringstream reason;
    reason << "cannot fit: law '" << model << "' has " << result.free_parameters
           << " parameters, and there are only " << samples.size() << " samples";
    throw std::invalid_argument(reason.str());
  }
  if (std::all_of(samples.force.begin(), samples.force.end(), [](double f) { return f == 0.0; })) {
    result.warnings.emplace_back("the force is zero throughout");
  }

  const Solution solution = search(problem, samples, all_of(samples), {});
  result.message = solution.message;
  if (solution.values.empty()) {
    result.warnings.emplace_back("too few samples, or too few on one branch, for as many parameters");
  } else {
    result.converged = solution.converged;
    result.iterations = solution.iterations;
    const auto residuals =
        residuals_of(models::Law::make(model, solution.values, problem.law_options), samples);
    measure_errors(result, residuals, samples, options.jnd);
    estimate_parameters(result, problem, solution, residuals, options.confidence);
    result.cv_rmse = cross_validate(problem, samples, solution.values);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

double line_rmse(const Series& series) {
  const auto n = static_cast<double>(series.force.size());
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < series.force.size(); ++i) {
    const Eigen::Vector2d row(1.0, series.penetration[i]);
    normal += row * row.transpose();
    right += row * series.force[i];
  }
  const Eigen::Vector2d line = solve_normal(normal, right);
  double squares = 0.0;
  for (std::size_t i = 0; i < series.force.size(); ++i) {
    const double error = line[0] + line[1] * series.penetration[i] - series.force[i];
    squares += error * error;
  }
  return std::sqrt(squares / n);
}

}  // namespace kerf::fitting

#include "kerf/fitting/fit.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include <boost/math/statistics/univariate_statistics.hpp>

#include "least_squares.h"
#include "samples.h"
#include "starts/search.h"
#include "uncertainty/estimates.h"

namespace kerf::fitting {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double robust_width = 1.345;  ///< Huber's, 95 % as good as least squares where the noise is normal
constexpr double deviation_of_mad = 1.4826;
constexpr double white_below = 3.0;      ///< samples of correlation time
constexpr double worth_one_more = 0.95;  ///< share of the held-out error that a larger law has to reach

std::vector<double> residuals_of(const Problem& problem, const Values& values, const Samples& samples) {
  std::vector<double> residuals = rendered(problem, values, samples);
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] -= samples.force[i];
  return residuals;
}

/// Root mean square of the residuals that are chosen; NaN if none is.
template <typename Chosen>
double rms_of(const std::vector<double>& residuals, Chosen&& chosen) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!chosen(i)) continue;
    squares += residuals[i] * residuals[i];
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : nothing;
}

void measure_errors(FitResult& result, const std::vector<double>& residuals, const Samples& samples,
                    const Jnd& jnd) {
  double n = 0.0, squares = 0.0, sum = 0.0, sum_of_squares = 0.0, felt = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.fold[i] == Samples::test) continue;
    n += 1.0;
    squares += residuals[i] * residuals[i];
    sum += samples.force[i];
    sum_of_squares += samples.force[i] * samples.force[i];
    result.max_abs = std::max(result.max_abs, std::abs(residuals[i]));
    felt += std::abs(residuals[i]) > jnd.at(samples.force[i]) ? 1.0 : 0.0;
  }
  const double total = sum_of_squares - sum * sum / n;
  result.rmse = std::sqrt(squares / n);
  result.r2 = total > 0.0 ? 1.0 - squares / total : 0.0;
  result.jnd_fraction = felt / n;
  result.effective_samples = n;
  result.test_rmse = rms_of(residuals, [&](std::size_t i) { return samples.fold[i] == Samples::test; });
}

/// Standard error of the root of a mean square that folds share, each with its own.
double spread_of(const std::vector<double>& held_out, const Samples& samples, double rmse) {
  std::vector<double> mean_squares;
  for (std::size_t fold = 0; fold < samples.folds; ++fold) {
    const double rms = rms_of(held_out, [&](std::size_t i) { return samples.fold[i] == fold; });
    if (std::isfinite(rms)) mean_squares.push_back(rms * rms);
  }
  if (mean_squares.size() < 2) return nothing;
  const double variance = boost::math::statistics::sample_variance(mean_squares);
  if (!(variance > 0.0)) return 0.0;
  return std::sqrt(variance / static_cast<double>(mean_squares.size())) / (2.0 * rmse);
}

/// Takes the error on samples that the fit has not seen; infinite if a fold could not be fitted.
void cross_validate(FitResult& result, const Problem& problem, const Samples& samples, const Weights& weights,
                    const Values& near, const RobustLoss& loss, std::size_t threads) {
  if (samples.folds < 2) return;
  std::vector<double> held_out(samples.size(), 0.0);
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  const auto work = [&] {
    for (std::size_t fold = next++; fold < samples.folds && !failed; fold = next++) {
      const Weights rest = without_fold(samples, weights, fold);
      const Solution solution =
          search(problem, samples, rest, near, {.loss = loss, .function_tolerance = 1e-8});
      if (solution.values.empty()) {
        failed = true;
        return;
      }
      const auto residuals = residuals_of(problem, solution.values, samples);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples.fold[i] == fold) held_out[i] = residuals[i];
      }
    }
  };
  {
    std::vector<std::future<void>> helpers;
    for (std::size_t i = 1; i < std::min(threads, samples.folds); ++i)
      helpers.push_back(std::async(std::launch::async, work));
    work();
    for (auto& helper : helpers) helper.get();  // throws what it threw
  }
  if (failed) {
    result.cv_rmse = std::numeric_limits<double>::infinity();
    return;
  }
  result.cv_rmse = rms_of(held_out, [&](std::size_t i) { return samples.fold[i] < samples.folds; });
  result.cv_std_error = spread_of(held_out, samples, result.cv_rmse);
}

/// 1.345 robust standard deviations of what least squares leaves.
double loss_scale(const std::vector<double>& residuals, const Weights& weights) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (weights[i] > 0.0) sizes.push_back(std::sqrt(weights[i]) * std::abs(residuals[i]));
  }
  const double middle = boost::math::statistics::median(sizes);
  return std::max(robust_width * deviation_of_mad * middle, std::numeric_limits<double>::min());
}

/// Each run weighed by what a first fit leaves in it.
Weights by_noise(const Samples& samples, const std::vector<double>& residuals) {
  Weights weights = all_of(samples);
  double first = 0.0;
  for (const Run& run : samples.runs) {
    const double noise = rms_of(residuals, [&](std::size_t i) {
      return i >= run.begin && i < run.end && samples.fold[i] != Samples::test;
    });
    if (!(noise > 0.0)) return all_of(samples);
    if (first == 0.0) first = noise;
    for (std::size_t i = run.begin; i < run.end; ++i) weights[i] *= first * first / (noise * noise);
  }
  return weights;
}

/// A sensor at the end of its range repeats its largest number.
void warn_of_the_sensor(FitResult& result, const Samples& samples) {
  const auto by_size = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const double largest = *std::max_element(samples.force.begin(), samples.force.end(), by_size);
  std::size_t longest = 0;
  std::size_t count = 0;
  std::size_t row = 0;
  for (const double force : samples.force) {
    row = force == largest ? row + 1 : 0;
    count += force == largest ? 1 : 0;
    longest = std::max(longest, row);
  }
  if (count == samples.size()) {
    result.warnings.emplace_back("the force never changes: a sensor that is stuck reads like that");
  } else if (longest >= 10 && 200 * count > samples.size()) {
    std::ostringstream warning;
    warning << "the force stands at its largest value, " << largest << " N, for " << count
            << " samples, up to " << longest << " in a row: the sensor may be saturated there";
    result.warnings.push_back(warning.str());
  }
}

void warn_of_a_misfit(FitResult& result) {
  if (!(result.r2 < 0.0)) return;
  std::ostringstream warning;
  warning << "it fits worse than the mean of the force does (R2 " << result.r2 << "), and is not chosen";
  result.warnings.push_back(warning.str());
}

/// What a law that only pushes leaves of a force that pulls is no noise.
void warn_of_pulling(FitResult& result, const std::vector<double>& residuals, const Samples& samples) {
  constexpr double noteworthy = 0.01;  // of the samples, and of the largest force
  double largest = 0.0;
  for (const double force : samples.force) largest = std::max(largest, std::abs(force));
  std::size_t pulling = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (residuals[i] + samples.force[i] < -1e-9 * largest) return;
    pulling += samples.force[i] < -noteworthy * largest ? 1 : 0;
  }
  const double share = static_cast<double>(pulling) / static_cast<double>(samples.size());
  if (share < noteworthy) return;
  std::ostringstream warning;
  warning << std::lround(100.0 * share) << " % of the samples pull, and this law only pushes";
  result.warnings.push_back(warning.str());
}

FitResult fit_problem(const Problem& problem, const Samples& samples, const FitOptions& options) {
  FitResult result{.model = std::string(problem.model), .law_options = problem.law_options};
  result.free_parameters = static_cast<std::size_t>(problem.coordinates());
  result.samples = samples.size();
  result.cv_rmse = result.cv_std_error = result.test_rmse = nothing;
  if (samples.size() <= result.free_parameters) {
    std::ostringstream reason;
    reason << "cannot fit: law '" << problem.model << "' has " << result.free_parameters
           << " parameters, and there are only " << samples.size() << " samples";
    throw std::invalid_argument(reason.str());
  }
  warn_of_the_sensor(result, samples);
  Weights weights = all_of(samples);
  RobustLoss loss;
  Solution solution = search(problem, samples, weights, {});
  const auto search_again = [&] {
    const int before = solution.iterations;
    solution = search(problem, samples, weights, solution.values, {.loss = loss});
    solution.iterations += before;
  };
  if (!solution.values.empty() && samples.runs.size() > 1 && samples.runs[0].noise_n == 0.0) {
    weights = by_noise(samples, residuals_of(problem, solution.values, samples));
    search_again();
  }
  if (!solution.values.empty() && options.loss != Loss::squares) {
    loss = {options.loss, options.loss_scale_n > 0.0
                              ? options.loss_scale_n
                              : loss_scale(residuals_of(problem, solution.values, samples), weights)};
    search_again();
  }
  result.message = solution.message;
  if (solution.values.empty()) {
    result.warnings.push_back(solution.message);
    return result;
  }
  result.converged = solution.converged;
  result.iterations = solution.iterations;
  const std::vector<double> residuals = residuals_of(problem, solution.values, samples);
  measure_errors(result, residuals, samples, options.jnd);
  warn_of_a_misfit(result);
  warn_of_pulling(result, residuals, samples);
  estimate_parameters(result, problem, samples, weights, solution, options, loss);
  result.weigh_information(result.effective_samples / std::max(1.0, result.correlation_time));
  cross_validate(result, problem, samples, weights, solution.values, loss, options.threads);
  return result;
}

/// A law as large as held-out cycles pay for: one more arm is taken if it lowers their error enough. Where
/// one does not but the residuals are still far from white, the next is tried too.
FitResult fit_growing(std::string_view model, const FitOptions& options, const Samples& samples) {
  const models::SizeFacts& size = models::law_facts(model).size;
  FitResult best;
  int failures = 0;
  for (std::size_t count = size.first; count <= size.last; ++count) {
    FitOptions sized(options);
    sized.law_options[std::string(size.option)] = static_cast<double>(count);
    FitResult next = fit_problem(make_problem(model, sized, samples), samples, sized);
    if (next.parameters.empty()) return best.parameters.empty() ? next : best;
    const bool white = next.correlation_time < white_below;
    const bool validated = std::isfinite(next.cv_rmse);
    if (!best.parameters.empty()) {
      const double independent = std::max(best.effective_samples, next.effective_samples);
      best.weigh_information(independent);
      next.weigh_information(independent);
    }
    const bool better = best.parameters.empty() ||
                        (validated ? next.cv_rmse < worth_one_more * best.cv_rmse : next.bic < best.bic);
    failures = better ? 0 : failures + 1;
    if (better) best = std::move(next);
    if (failures == 2) break;
    if (white) break;  // there is nothing left to explain
  }
  return best;
}

}  // namespace

void FitResult::weigh_information(double independent_samples) {
  effective_samples = independent_samples;
  const double variance = std::max(rmse * rmse, std::numeric_limits<double>::min());
  const double likelihood = effective_samples * std::log(variance);
  const auto p = static_cast<double>(free_parameters + 1);  // the noise is one more
  const double left = effective_samples - p - 1.0;
  aic = likelihood + 2.0 * p;
  aicc = left > 0.0 ? aic + 2.0 * p * (p + 1.0) / left : std::numeric_limits<double>::infinity();
  bic = likelihood + p * std::log(effective_samples);
}

models::Law FitResult::law(std::size_t recording) const {
  std::vector<double> values;
  for (const Estimate& estimate : parameters) {
    values.push_back(estimate.value);
    for (const Estimate& other : others) {
      if (other.info.name == estimate.info.name && other.recording == recording) values.back() = other.value;
    }
  }
  return models::Law::make(model, values, law_options);
}

const std::vector<std::string_view>& fitted_laws() {
  static const std::vector<std::string_view> laws = [] {
    std::vector<std::string_view> scalar;
    for (const models::LawInfo& law : models::registry()) {
      if (models::Law::axes(law.name).empty()) scalar.push_back(law.name);
    }
    return scalar;
  }();
  return laws;
}

void check_model(std::string_view model) {
  (void)models::Law::options(model);  // an unknown law is told as such
  if (std::find(fitted_laws().begin(), fitted_laws().end(), model) != fitted_laws().end()) return;
  std::string message = "law '" + std::string(model) +
                        "' acts on several axes and cannot be fitted along one; those that can are";
  for (const std::string_view law : fitted_laws()) {
    message += (law == fitted_laws().front() ? " " : ", ") + std::string(law);
  }
  throw std::invalid_argument(message);
}

FitResult fit(std::string_view model, std::span<const Series> recordings, const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  check_model(model);
  const Samples samples =
      check_series(recordings, {.folds = options.folds, .test_share = options.test_share});
  if (std::all_of(samples.force.begin(), samples.force.end(), [](double f) { return f == 0.0; })) {
    throw std::invalid_argument("cannot fit: the force is zero throughout");
  }
  const models::SizeFacts& size = models::law_facts(model).size;
  const bool grows = size.grows && !options.law_options.contains(size.option);
  FitResult result = grows ? fit_growing(model, options, samples)
                           : fit_problem(make_problem(model, options, samples), samples, options);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

FitResult fit(std::string_view model, const Series& series, const FitOptions& options) {
  return fit(model, std::span(&series, 1), options);
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

#include "kerf/fitting/fit.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "kerf/fitting/checked_recordings.h"
#include "samples.h"
#include "training/held_out.h"
#include "training/trained_memory.h"
#include "uncertainty/estimates.h"

namespace kerf::fitting {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Root mean squares of what a fit saw, and of what was held back for a test; NaN of none.
struct RootMeanSquares {
  double seen = nothing, test = nothing;
};
RootMeanSquares rms_of(const std::vector<double>& residuals, const Samples& samples) {
  const auto rms = [](const Numbers& numbers) {
    return numbers.size() > 0 ? std::sqrt(numbers.square().mean()) : nothing;
  };
  std::vector<double> kept;
  std::vector<double> held_back;
  for (std::size_t i = 0; i < residuals.size() && !samples.all_seen; ++i) {
    if (samples.counts[i] != 0 && samples.fold[i] == Samples::test) held_back.push_back(residuals[i]);
  }
  return {.seen = rms(seen_of(samples, residuals, kept)), .test = rms(numbers_of(held_back))};
}

void tell_a_part(const FitOptions& options) {
  if (options.part_done) options.part_done();
}

void measure_errors(FitResult& result, const std::vector<double>& residuals, const Samples& samples,
                    const Jnd& jnd) {
  std::array<std::vector<double>, 2> kept;
  const Numbers force = seen_of(samples, samples.force, kept[0]);
  const Numbers left = seen_of(samples, residuals, kept[1]);
  const auto n = static_cast<double>(force.size());
  Eigen::Index felt = 0;
  for (Eigen::Index i = 0; i < force.size(); ++i) felt += std::abs(left[i]) > jnd.at(force[i]) ? 1 : 0;
  const double total = force.square().sum() - n * force.mean() * force.mean();
  const RootMeanSquares errors = rms_of(residuals, samples);
  const double squares = n * errors.seen * errors.seen;
  result.rmse = errors.seen;
  result.max_abs = left.size() > 0 ? left.abs().maxCoeff() : 0.0;
  result.r2 = total > 0.0 ? 1.0 - squares / total : 0.0;
  result.jnd_fraction = static_cast<double>(felt) / n;
  result.effective_samples = n;
  result.test_rmse = errors.test;
}

/// Rows before all that count, where nothing is felt: a law that is felt pushes at nothing. A tool that was
/// closed with nothing in it is as deep as in the tissue, and says nothing of this.
void measure_in_free_air(FitResult& result, const std::vector<double>& residuals, const Samples& samples,
                         const FitOptions& options) {
  constexpr std::size_t fewest = 100;
  if (samples.size() - result.samples < fewest) return;
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.counts[i] != 0) first = std::min(first, samples.motion[i].penetration);
  }
  std::size_t count = 0;
  std::size_t felt = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool is_before = samples.counts[i] == 0 && samples.motion[i].penetration < first;
    if (!is_before || std::abs(samples.force[i]) > options.jnd.threshold) continue;
    ++count;
    felt += std::abs(residuals[i]) > options.jnd.threshold ? 1 : 0;
  }
  if (count < fewest) return;
  result.free_fraction = static_cast<double>(felt) / static_cast<double>(count);
  if (!result.is_felt_in_free_air()) return;
  std::ostringstream warning;
  warning << "it is felt where the tool is free, in " << std::lround(100.0 * result.free_fraction)
          << " % of the rows without a force, and is not chosen";
  result.warnings.push_back(warning.str());
}

/// The same of the law as it is rendered.
void measure_rendered(FitResult& result, const std::vector<double>& residuals, const Samples& samples) {
  if (residuals.empty()) return;
  const RootMeanSquares errors = rms_of(residuals, samples);
  result.rendered.rmse = errors.seen;
  result.rendered.test_rmse = errors.test;
}

/// A sensor at the end of its range repeats its largest number.
void warn_of_the_sensor(FitResult& result, const Samples& samples, const std::string& unit) {
  const double largest =
      *std::ranges::find(samples.force, samples.largest_force, [](double force) { return std::abs(force); });
  const auto count = static_cast<std::size_t>((numbers_of(samples.force) == largest).count());
  if (200 * count <= samples.size()) return;
  std::size_t longest = 0;
  std::size_t row = 0;
  for (const double force : samples.force) {
    row = force == largest ? row + 1 : 0;
    longest = std::max(longest, row);
  }
  if (longest >= 10) {
    std::ostringstream warning;
    warning << "the force stands at its largest value, " << largest << " " << unit << ", for " << count
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

/// Whether the law pulls where the tool is on the other side, and goes the other way.
bool can_pull(const Trained& law, Samples samples) {
  for (models::Motion& motion : samples.motion)
    motion = {.penetration = -motion.penetration, .velocity = -motion.velocity};
  const std::vector<double> force = rendered(law.problem, law.solution.values, samples);
  return std::ranges::any_of(force, [](double one) { return one < 0.0; });
}

/// What a law that only pushes leaves of a force that pulls is no noise: where it renders none, noise pushes
/// as often as it pulls.
void warn_of_pulling(FitResult& result, const Trained& law, const std::vector<double>& residuals,
                     const Samples& samples) {
  constexpr double noteworthy = 0.01;  // of the samples, and of the largest force
  constexpr double beyond_noise = 4.0;
  constexpr double by_chance = 4.0;  // standard errors
  const double largest = samples.largest_force;
  const auto pulls =
      std::ranges::count_if(samples.force, [&](double f) { return f < -noteworthy * largest; });
  if (static_cast<double>(pulls) < noteworthy * static_cast<double>(samples.size())) return;
  const double strong = std::max(noteworthy * largest, beyond_noise * noise_of_rows(samples));
  double pulling = 0.0;
  double pushing = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double rendered = residuals[i] + samples.force[i];
    if (rendered < -1e-9 * largest) return;
    if (samples.force[i] < -strong) pulling += 1.0;
    if (samples.force[i] > strong && rendered < noteworthy * largest) pushing += 1.0;
  }
  const double share = (pulling - pushing) / static_cast<double>(samples.size());
  if (share < noteworthy || pulling - pushing < by_chance * std::sqrt(pulling + pushing)) return;
  if (can_pull(law, samples)) return;
  std::ostringstream warning;
  warning << std::lround(100.0 * share) << " % of the samples pull, and this law only pushes";
  const auto options = models::Law::options(result.model);
  if (std::ranges::find(options, "bilateral", &models::OptionInfo::name) != options.end())
    warning << "; with the option bilateral=true it pulls too";
  result.warnings.push_back(warning.str());
}

/// The error of the whole way to a law, choice of its size and all, on samples that it was not shown.
void cross_validate(FitResult& result, const FitOptions& options, const Samples& samples,
                    TrainedMemory& memory) {
  if (samples.folds < 2) return;
  FitOptions alone(options);
  alone.threads = 1;  // the folds are shared out already
  const auto train_on = [&](Weights seen) {
    Trained law = train(result.model, alone, samples, std::move(seen), of_a_fold, &memory);
    tell_a_part(options);
    return law;
  };
  const HeldOut errors = held_out(train_on, samples, all_of(samples), options.threads, options.render);
  result.cv_rmse = errors.fitted.rmse;
  result.cv_std_error = standard_error(errors.fitted);
  result.cv_folds = errors.fitted.folds;
  if (!options.render) return;
  result.rendered.cv_rmse = errors.rendered.rmse;
  result.rendered.cv_std_error = standard_error(errors.rendered);
  result.rendered.cv_folds = errors.rendered.folds;
}

/// The errors of a law that was found, and what is said of them.
void measure(FitResult& result, const Trained& law, const Samples& samples, const FitOptions& options) {
  const std::vector<double> residuals = residuals_of(law.problem, law.solution.values, samples);
  measure_errors(result, residuals, samples, options.jnd);
  measure_rendered(result, rendered_residuals(law.problem, law.solution.values, samples, options.render),
                   samples);
  measure_in_free_air(result, residuals, samples, options);
  warn_of_a_misfit(result);
  warn_of_pulling(result, law, residuals, samples);
}

FitResult fit_samples(std::string_view model, const Samples& samples, const FitOptions& options) {
  TrainedMemory memory;
  Trained law =
      train(model, options, samples, all_of(samples), options.brief ? of_a_fold : of_a_law, &memory);
  FitResult result{.model = std::string(model), .law_options = law.problem.law_options};
  result.free_parameters = static_cast<std::size_t>(law.problem.coordinates());
  result.samples = static_cast<std::size_t>(std::ranges::count(samples.counts, 1));
  result.cv_rmse = result.cv_std_error = result.test_rmse = nothing;
  warn_of_the_sensor(result, samples, options.force_unit);
  result.message = law.solution.message;
  if (law.solution.values.empty()) {
    result.warnings.push_back(law.solution.message);
    return result;
  }
  result.converged = law.solution.converged;
  result.iterations = law.solution.iterations;
  if (law.loss.kind != Loss::squares) result.loss_scale_n = law.loss.scale;
  tell_a_part(options);
  measure(result, law, samples, options);
  estimate_parameters(result, law.problem, samples, law.weights, law.solution, options, law.loss);
  Weights().swap(law.weights);  // of very many samples each column tells
  tell_a_part(options);
  // A valley without an end, and all of it as good.
  if (!result.converged && result.undetermined_arms + result.undetermined_directions > 0) {
    result.converged = true;
    result.message = result.undetermined_arms > 0
                         ? "the sum of squares stands still along an arm that is not determined"
                         : "the sum of squares stands still along a change that the data do not tell";
  }
  result.weigh_information(result.effective_samples / std::max(1.0, result.correlation_time));
  cross_validate(result, options, samples, memory);
  return result;
}

}  // namespace

std::size_t parts_of_a_fit(const FitOptions& options) noexcept { return 2 + options.folds; }

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

double FitResult::held_out_rmse() const noexcept {
  return std::isnan(rendered.cv_rmse) ? cv_rmse : rendered.cv_rmse;
}

double FitResult::held_out_test() const noexcept {
  return std::isnan(rendered.test_rmse) ? test_rmse : rendered.test_rmse;
}

const std::vector<double>& FitResult::held_out_folds() const noexcept {
  return std::isnan(rendered.cv_rmse) ? cv_folds : rendered.cv_folds;
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

std::vector<std::string_view> fitted_laws() {
  std::vector<std::string_view> scalar;
  for (const models::LawInfo& law : models::registry()) {
    if (models::Law::axes(law.name).empty()) scalar.push_back(law.name);
  }
  return scalar;
}

void check_model(std::string_view model) {
  (void)models::Law::options(model);  // an unknown law is told as such
  const std::vector<std::string_view> laws = fitted_laws();
  if (std::find(laws.begin(), laws.end(), model) != laws.end()) return;
  std::string message = "law '" + std::string(model) +
                        "' acts on several axes and cannot be fitted along one; those that can are";
  for (const std::string_view law : laws) message += (law == laws.front() ? " " : ", ") + std::string(law);
  throw std::invalid_argument(message);
}

CheckedRecordings::CheckedRecordings(std::span<const Series> recordings, const FitOptions& options)
    : samples_(std::make_unique<const Samples>(
          check_series(recordings, {.folds = options.folds, .test_share = options.test_share}))) {}

CheckedRecordings::~CheckedRecordings() = default;

FitResult fit(std::string_view model, const CheckedRecordings& recordings, const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  check_model(model);
  FitResult result = fit_samples(model, recordings.samples(), options);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

FitResult fit(std::string_view model, std::span<const Series> recordings, const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  check_model(model);
  FitResult result = fit(model, CheckedRecordings(recordings, options), options);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

FitResult fit(std::string_view model, const Series& series, const FitOptions& options) {
  return fit(model, std::span(&series, 1), options);
}

double rms_of(const Series& series) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < series.force.size(); ++i) {
    if (!series.counts.empty() && series.counts[i] == 0) continue;
    squares += series.force[i] * series.force[i];
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

}  // namespace kerf::fitting

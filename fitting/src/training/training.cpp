#include "training/training.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "training/held_out.h"
#include "training/trained_memory.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

constexpr double robust_width = 1.345;   ///< Huber's, 95 % as good as least squares where the noise is normal
constexpr double white_below = 3.0;      ///< samples of correlation time
constexpr double worth_one_more = 0.95;  ///< share of the held-out error that a larger law has to reach
constexpr std::size_t failures_borne = 2;  ///< sizes in a row that do not pay

std::vector<double> of_those(const std::vector<double>& values, const Weights& seen) {
  std::vector<double> chosen;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (seen[i] > 0.0) chosen.push_back(values[i]);
  }
  return chosen;
}

/// 1.345 robust standard deviations of what least squares leaves.
double loss_scale(const std::vector<double>& residuals, const Weights& weights) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (weights[i] > 0.0) sizes.push_back(std::sqrt(weights[i]) * std::abs(residuals[i]));
  }
  return std::max(robust_width * robust_deviation(std::move(sizes)), std::numeric_limits<double>::min());
}

/// Each run weighed by what a first fit leaves in it.
Weights by_noise(const Samples& samples, const std::vector<double>& residuals, const Weights& seen) {
  Weights weights(seen);
  double first = 0.0;
  for (const Run& run : samples.runs) {
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (!(seen[i] > 0.0)) continue;
      squares += residuals[i] * residuals[i];
      count += 1.0;
    }
    if (!(squares > 0.0)) return seen;
    const double variance = squares / count;
    if (first == 0.0) first = variance;
    for (std::size_t i = run.begin; i < run.end; ++i) weights[i] *= first / variance;
  }
  return weights;
}

/// Whether the search of a law by descent goes on from the values of all samples: where they leave less of
/// the samples shown than where it has ended, or lie elsewhere and leave no more than these samples can tell
/// apart.
bool goes_on_from(const Values& whole, const Trained& law, const Samples& samples) {
  constexpr double noteworthy = 1e-6;  // a share of the sum of squares
  constexpr double not_told = 10.0;    // variances: parameters of other samples leave some more, by chance
  constexpr double elsewhere = 0.5;    // of a parameter
  const Values& found = law.solution.values;
  if (law.problem.facts().search != models::Search::descent || whole.size() != found.size()) return false;
  const double left = squares_of(law.problem, samples, law.weights, whole);
  if (left < (1.0 - noteworthy) * law.solution.squares) return true;
  const auto shown =
      static_cast<double>(std::ranges::count_if(law.weights, [](double w) { return w > 0.0; }));
  const auto is_elsewhere = [&](std::size_t run) {
    for (std::size_t i = 0; i < found[run].size(); ++i) {
      const double largest = std::max(std::abs(found[run][i]), std::abs(whole[run][i]));
      if (std::abs(found[run][i] - whole[run][i]) > elsewhere * largest) return true;
    }
    return false;
  };
  bool lies_elsewhere = false;
  for (std::size_t run = 0; run < found.size(); ++run) lies_elsewhere = lies_elsewhere || is_elsewhere(run);
  return lies_elsewhere && left <= (1.0 + not_told / shown) * law.solution.squares;
}

/// Of the samples those that all_of() gives a weight.
std::size_t how_many_to_see(const Samples& samples) {
  if (samples.all_seen) return samples.size();
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) count += samples.is_seen(i) ? 1 : 0;
  return count;
}

/// A law of a given size.
Trained train_sized(std::string_view model, const FitOptions& options, const Samples& samples, Weights seen,
                    double function_tolerance, TrainedMemory* memory) {
  const Polish polish = function_tolerance < of_a_fold ? Polish::thorough : Polish::brief;
  Trained law{.problem = make_problem(model, options, samples, seen, polish)};
  law.weights = std::move(seen);
  if (memory != nullptr) law.problem.arm_memory = memory->arms();
  const auto p = static_cast<std::size_t>(law.problem.coordinates());
  const auto count =
      static_cast<std::size_t>(std::ranges::count_if(law.weights, [](double w) { return w > 0.0; }));
  if (count <= p) {
    std::ostringstream reason;
    reason << "cannot fit: law '" << model << "' has " << p << " parameters, and there are only " << count
           << " samples";
    throw std::invalid_argument(reason.str());
  }
  const auto found_by = [&](const Values& near) {
    return search(law.problem, samples, law.weights, near,
                  {.loss = law.loss, .function_tolerance = function_tolerance});
  };
  const auto left = [&] { return residuals_of(law.problem, law.solution.values, samples); };
  const auto search_again = [&] {
    Solution before = std::move(law.solution);
    law.solution = found_by(before.values);
    law.solution.iterations += before.iterations;
    law.solution.rivals = std::move(before.rivals);  // which a search from one place does not meet
  };
  law.solution = found_by({});
  // Samples without a stroke may offer no start that leads to the least, or not tell it from another.
  const Values* const whole = memory == nullptr ? nullptr : memory->whole(law.solution.values);
  if (whole != nullptr && goes_on_from(*whole, law, samples)) {
    Solution from_whole = found_by(*whole);
    from_whole.iterations += law.solution.iterations;
    from_whole.rivals = std::move(law.solution.rivals);
    law.solution = std::move(from_whole);
  }
  if (!law.solution.values.empty() && samples.runs.size() > 1 && samples.runs[0].noise_n == 0.0) {
    law.weights = by_noise(samples, left(), law.weights);
    search_again();
  }
  if (!law.solution.values.empty() && options.loss != Loss::squares) {
    law.loss = {options.loss,
                options.loss_scale_n > 0.0 ? options.loss_scale_n : loss_scale(left(), law.weights)};
    search_again();
  }
  if (memory != nullptr && !law.solution.values.empty() && count == how_many_to_see(samples))
    memory->keep_whole(law.solution.values);
  return law;
}

/// A size of a law, tried.
struct Size {
  Trained law;
  HeldOut errors;
  double mean_square = 0.0;  ///< of the residuals of the samples shown
  std::size_t count = 0;
};

double bic_of(const Size& size, double independent_samples) {
  FitResult result{.free_parameters = static_cast<std::size_t>(size.law.problem.coordinates())};
  result.rmse = std::sqrt(size.mean_square);
  result.weigh_information(independent_samples);
  return result.bic;
}

bool pays(const Size& larger, const Size& smaller) {
  if (std::isfinite(larger.errors.fitted.rmse) && std::isfinite(smaller.errors.fitted.rmse)) {
    const Paired gain = paired(smaller.errors.fitted.folds, larger.errors.fitted.folds);
    return larger.errors.fitted.rmse < worth_one_more * smaller.errors.fitted.rmse &&
           gain.mean > gain.std_error;
  }
  if (!std::isnan(larger.errors.fitted.rmse)) return std::isfinite(larger.errors.fitted.rmse);
  const auto worth = [](const Size& size) {
    return static_cast<double>(size.count) / std::max(1.0, size.law.correlation_time);
  };
  const double independent = std::max(worth(smaller), worth(larger));
  return bic_of(larger, independent) < bic_of(smaller, independent);
}

/// A law of a given size, found once: nested folds ask again.
Trained train_once(std::string_view model, const FitOptions& sized, std::size_t count, const Samples& samples,
                   const Weights& seen, double function_tolerance, TrainedMemory* memory) {
  const auto train = [&] { return train_sized(model, sized, samples, seen, function_tolerance, memory); };
  return memory != nullptr ? memory->once(seen, count, function_tolerance, train) : train();
}

/// Its folds are not fitted where its held-out error cannot come below `enough`.
Size tried(std::string_view model, const FitOptions& sized, std::size_t count, const Samples& samples,
           const Weights& seen, double function_tolerance, TrainedMemory* memory, double enough) {
  Size size{.law = train_once(model, sized, count, samples, seen, function_tolerance, memory)};
  if (size.law.solution.values.empty()) return size;
  const std::vector<double> residuals = residuals_of(size.law.problem, size.law.solution.values, samples);
  const auto left = of_those(residuals, seen);
  size.count = left.size();
  size.mean_square = std::pow(rms_of(left), 2);
  size.law.correlation_time = correlation_time(left);
  const bool least_squares = samples.runs.size() == 1 && sized.loss == Loss::squares;
  if (least_squares && least_held_out(residuals, samples, seen) >= enough) {
    size.errors.fitted.rmse = std::numeric_limits<double>::infinity();
    return size;
  }
  size.errors = held_out(
      [&](const Weights& fewer) {
        return train_once(model, sized, count, samples, fewer, of_a_fold, memory);
      },
      samples, seen, sized.threads);
  return size;
}

/// A law as large as held-out samples among those shown pay for. Where one more does not but the residuals
/// are still far from white, the next is tried too.
Trained train_growing(std::string_view model, const FitOptions& options, const Samples& samples,
                      const Weights& seen, double function_tolerance, TrainedMemory* memory) {
  const models::SizeFacts& facts = models::law_facts(model).size;
  std::optional<Size> best;
  std::size_t failures = 0;
  for (std::size_t count = facts.first; count <= facts.last && failures < failures_borne; ++count) {
    FitOptions sized(options);
    sized.law_options[std::string(facts.option)] = static_cast<double>(count);
    const double enough = best && std::isfinite(best->errors.fitted.rmse)
                              ? worth_one_more * best->errors.fitted.rmse
                              : std::numeric_limits<double>::infinity();
    Size next = tried(model, sized, count, samples, seen, function_tolerance, memory, enough);
    if (next.law.solution.values.empty()) return best ? best->law : next.law;
    const bool white = next.law.correlation_time < white_below;
    const bool better = !best || pays(next, *best);
    failures = better ? 0 : failures + 1;
    if (better) best = std::move(next);
    if (white) break;  // there is nothing left to explain
  }
  return best->law;
}

}  // namespace

std::vector<double> residuals_of(const Problem& problem, const Values& values, const Samples& samples) {
  std::vector<double> residuals = rendered(problem, values, samples);
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] -= samples.force[i];
  return residuals;
}

std::vector<double> rendered_residuals(const Problem& problem, const Values& values, const Samples& samples,
                                       const decltype(FitOptions::render)& render) {
  std::vector<double> residuals;
  if (!render) return residuals;
  for (std::size_t run = 0; run < samples.runs.size(); ++run) {
    auto part = render(models::Law::make(problem.model, values[run], problem.law_options), run);
    if (samples.runs.size() == 1) {
      residuals = std::move(part);  // memory for one column, not for two
      break;
    }
    residuals.insert(residuals.end(), part.begin(), part.end());
  }
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] -= samples.force[i];
  return residuals;
}

Trained train(std::string_view model, const FitOptions& options, const Samples& samples, Weights seen,
              double function_tolerance, TrainedMemory* memory) {
  const models::SizeFacts& size = models::law_facts(model).size;
  const bool grows = size.grows && !options.law_options.contains(size.option);
  return grows ? train_growing(model, options, samples, seen, function_tolerance, memory)
               : train_sized(model, options, samples, std::move(seen), function_tolerance, memory);
}

}  // namespace kerf::fitting

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>
#include <utility>
#include <vector>

#include <kerf/models/law.h>

#include "kerf/fitting/fit.h"
#include "training/held_out.h"

namespace kerf::fitting {
namespace {

constexpr double nearly = 1.05;  ///< times the least error: cycles that differ much hide what a hand feels

Choice no_choice(std::span<const FitResult> results) {
  return {.model = "",
          .why = results.empty() ? "no law could be fitted"
                                 : "of the laws that were fitted none converged to what explains the force "
                                   "better than its mean does and is not felt where the tool is free"};
}

/// The laws that are not out of the question; those that say no more than a simpler one only where there is
/// no other.
template <typename Measure>
std::vector<const FitResult*> eligible(std::span<const FitResult> results, Measure&& measure) {
  std::vector<const FitResult*> laws;
  for (const FitResult& result : results) {
    if (result.can_be_chosen() && std::isfinite(measure(result))) laws.push_back(&result);
  }
  const auto determined = [](const FitResult* law) { return law->undetermined_arms == 0; };
  if (std::ranges::any_of(laws, determined)) std::erase_if(laws, std::not_fn(determined));
  return laws;
}

/// By which of its errors a law is judged, in the words of the tables that have a column for each.
const char* held_out_in_words(const FitResult& law, const FitOptions& options) {
  const double rendered = options.folds > 0 ? law.rendered.cv_rmse : law.rendered.test_rmse;
  return std::isnan(rendered) ? "held-out data" : "held-out data as rendered";
}

Choice least_bic(std::span<const FitResult> results) {
  const auto laws = eligible(results, [](const FitResult& law) { return law.bic; });
  if (laws.empty()) return no_choice(results);
  const FitResult& best = **std::ranges::min_element(laws, {}, [](const FitResult* law) { return law->bic; });
  std::ostringstream why;
  why << best.model << " has the least BIC (" << std::fixed << std::setprecision(0) << best.bic
      << "); no data were held out to judge the laws by";
  return {.model = best.model, .why = why.str()};
}

}  // namespace

double left_out(double error_n, double better_n) noexcept {
  return error_n > better_n ? std::sqrt(error_n * error_n - better_n * better_n) : 0.0;
}

bool as_good_as(const FitResult& law, const FitResult& best, double jnd_n) {
  if (left_out(law.held_out_rmse(), best.held_out_rmse()) <= jnd_n) return true;
  const Paired worse = paired(law.held_out_folds(), best.held_out_folds());
  return law.held_out_rmse() <= nearly * best.held_out_rmse() && worse.std_error > 0.0 &&
         worse.mean <= worse.std_error;
}

Choice choose_simplest(std::span<const FitResult> results, const Series& series, const FitOptions& asked,
                       double line_rmse) {
  // Of what a test leaves there may be too little for folds.
  FitOptions options(asked);
  const auto has_folds = [](const FitResult& law) { return !std::isnan(law.held_out_rmse()); };
  if (std::ranges::none_of(results, has_folds)) options.folds = 0;
  if (options.folds == 0 && !(options.test_share > 0.0)) return least_bic(results);
  const auto error = [&](const FitResult& law) {
    return options.folds > 0 ? law.held_out_rmse() : law.held_out_test();
  };
  auto candidates = eligible(results, error);
  if (candidates.empty()) return no_choice(results);
  const double force_rms = rms_of(series);
  const double limit = options.jnd.at(force_rms);
  if (force_rms <= limit) {
    std::ostringstream why;
    why << std::setprecision(3) << "no force at all is within the JND of " << limit << " "
        << options.force_unit << " too, at a root mean square force of " << force_rms << " "
        << options.force_unit << ": there is nothing to choose by";
    return {.model = "", .why = why.str()};
  }
  const auto best =
      *std::ranges::min_element(candidates, {}, [&](const FitResult* result) { return error(*result); });
  const std::string unit = " " + options.force_unit;
  if (error(*best) >= force_rms) {
    std::ostringstream why;
    why << std::setprecision(3) << "no law does better on " << held_out_in_words(*best, options)
        << " than no force at all: the best, " << best->model << ", errs by " << error(*best) << unit
        << " where the root mean square force is " << force_rms << unit;
    return {.model = "", .why = why.str()};
  }
  const bool felt = error(*best) > limit;
  // As fitted, as the line is: it is not rendered.
  const auto least = [](const FitResult* law) { return law->cv_rmse; };
  const FitResult& nearest = **std::ranges::min_element(candidates, {}, least);
  if (felt && options.folds > 0 && nearest.cv_rmse > nearly * line_rmse) {
    std::ostringstream why;
    why << std::setprecision(3) << "no law does as well on held-out data as a straight line of force over "
        << "penetration: the best, " << nearest.model << ", errs by " << nearest.cv_rmse << unit
        << " where the line errs by " << line_rmse << unit;
    return {.model = "", .why = why.str()};
  }
  const auto serves = [&](const FitResult* result) {
    if (!felt) return error(*result) <= limit;
    return options.folds > 0 ? as_good_as(*result, *best, limit)
                             : left_out(error(*result), error(*best)) <= limit;
  };
  std::ranges::stable_sort(candidates, {}, [](const FitResult* law) {
    return std::pair(law->free_parameters, models::place_in_registry(law->model));
  });
  const auto chosen = *std::ranges::find_if(candidates, serves);
  std::ostringstream why;
  why << std::setprecision(3);
  if (felt) {
    const bool is_passed_over = std::ranges::any_of(
        results, [&](const FitResult& law) { return !law.can_be_chosen() && error(law) <= limit; });
    why << (is_passed_over
                ? "no law that explains the force better than its mean does, and is not felt where "
                  "the tool is free, stays"
                : "no law stays")
        << " within the JND of " << limit << unit << " (at the root mean square force of " << force_rms
        << unit << ") on " << held_out_in_words(*chosen, options) << "; " << chosen->model << " with "
        << error(*chosen) << unit << " has the fewest parameters (" << chosen->free_parameters
        << ") of those that do as well as the best";
    if (chosen == best) {
      why << ", which it is itself";
    } else {
      why << ", " << best->model << " with " << error(*best) << unit;
    }
  } else {
    why << chosen->model << " has the fewest parameters (" << chosen->free_parameters
        << ") of the laws whose error on " << held_out_in_words(*chosen, options) << " (" << error(*chosen)
        << unit << ") stays within the JND of " << limit << unit << " (at the root mean square force of "
        << force_rms << unit << ")";
  }
  return {.model = chosen->model, .why = why.str()};
}

}  // namespace kerf::fitting

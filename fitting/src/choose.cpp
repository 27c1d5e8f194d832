#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

#include "kerf/fitting/fit.h"

namespace kerf::fitting {
namespace {

constexpr double as_good_as_best = 1.05;
const Choice no_choice{.model = "", .why = "no law could be fitted"};

Choice least_bic(std::span<const FitResult> results) {
  const FitResult* best = nullptr;
  for (const FitResult& result : results) {
    if (result.can_be_chosen() && (best == nullptr || result.bic < best->bic)) best = &result;
  }
  if (best == nullptr) return no_choice;
  std::ostringstream why;
  why << best->model << " has the least BIC (" << std::fixed << std::setprecision(0) << best->bic
      << "); no data were held out to judge the laws by";
  return {.model = best->model, .why = why.str()};
}

}  // namespace

Choice choose_simplest(std::span<const FitResult> results, const Series& series, const FitOptions& options) {
  if (options.folds == 0 && !(options.test_share > 0.0)) return least_bic(results);
  const auto error = options.folds > 0 ? &FitResult::cv_rmse : &FitResult::test_rmse;
  std::vector<const FitResult*> candidates;
  for (const FitResult& result : results) {
    if (result.can_be_chosen() && std::isfinite(result.*error)) candidates.push_back(&result);
  }
  if (candidates.empty()) return no_choice;
  const double force_rms = rms_of(series.force);
  const double limit = options.jnd.at(force_rms);
  const auto best =
      *std::ranges::min_element(candidates, {}, [&](const FitResult* result) { return result->*error; });
  const bool felt = best->*error > limit;
  const double allowed = felt ? as_good_as_best * best->*error : limit;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto* a, const auto* b) { return a->free_parameters < b->free_parameters; });
  const auto chosen = *std::find_if(candidates.begin(), candidates.end(),
                                    [&](const auto* result) { return result->*error <= allowed; });
  std::ostringstream why;
  why << std::setprecision(3);
  if (felt) {
    why << "no law stays within the JND of " << limit << " N (at the root mean square force of " << force_rms
        << " N) on held-out data; " << chosen->model << " with " << chosen->*error
        << " N has the fewest parameters (" << chosen->free_parameters << ") of those within "
        << std::lround(100.0 * (as_good_as_best - 1.0)) << " % of the best, " << best->model << " with "
        << best->*error << " N";
  } else {
    why << chosen->model << " has the fewest parameters (" << chosen->free_parameters
        << ") of the laws whose error on held-out data (" << chosen->*error << " N) stays within the JND of "
        << limit << " N (at the root mean square force of " << force_rms << " N)";
  }
  return {.model = chosen->model, .why = why.str()};
}

}  // namespace kerf::fitting

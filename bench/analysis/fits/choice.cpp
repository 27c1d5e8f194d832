#include "fits/choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/core.h>

namespace kerf::bench {

double jnd_of(std::span<const double> force, const fitting::ForceJnd& jnd) {
  const double squares = std::inner_product(force.begin(), force.end(), force.begin(), 0.0);
  return jnd.at(std::sqrt(squares / static_cast<double>(force.size())));
}

fitting::Choice choose(std::span<const fitting::FitResult> results, const fitting::Series& series,
                       const fitting::FitOptions& options) {
  if (options.folds > 0) return fitting::choose_simplest(results, series, options.jnd);
  if (options.test_share > 0.0) {
    std::vector<fitting::FitResult> tested(results.begin(), results.end());
    for (fitting::FitResult& result : tested) result.cv_rmse = result.test_rmse;
    return fitting::choose_simplest(tested, series, options.jnd);
  }
  const fitting::FitResult* best = nullptr;
  for (const fitting::FitResult& result : results) {
    if (result.converged && (best == nullptr || result.bic < best->bic)) best = &result;
  }
  if (best == nullptr) return {.model = "", .why = "no law could be fitted"};
  return {.model = best->model,
          .why = fmt::format("{} has the least BIC ({:.0f}); no data were held out to judge the laws by, "
                             "so this favours those with many parameters",
                             best->model, best->bic)};
}

}  // namespace kerf::bench

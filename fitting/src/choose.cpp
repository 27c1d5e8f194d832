#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <vector>

#include "kerf/fitting/fit.h"

namespace kerf::fitting {
namespace {

constexpr double as_good_as_best = 1.05;

}  // namespace

Choice choose_simplest(std::span<const FitResult> results, const Series& series, const ForceJnd& jnd) {
  std::vector<const FitResult*> candidates;
  for (const FitResult& result : results) {
    if (result.converged && std::isfinite(result.cv_rmse)) candidates.push_back(&result);
  }
  if (candidates.empty()) return {.model = "", .why = "no law could be fitted"};
  const double force_rms =
      std::sqrt(std::inner_product(series.force.begin(), series.force.end(), series.force.begin(), 0.0) /
                static_cast<double>(series.force.size()));
  const double limit = jnd.at(force_rms);
  const auto best = *std::min_element(candidates.begin(), candidates.end(),
                                      [](const auto* a, const auto* b) { return a->cv_rmse < b->cv_rmse; });
  const bool felt = best->cv_rmse > limit;
  const double allowed = felt ? as_good_as_best * best->cv_rmse : limit;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto* a, const auto* b) { return a->free_parameters < b->free_parameters; });
  const auto chosen = *std::find_if(candidates.begin(), candidates.end(),
                                    [&](const auto* result) { return result->cv_rmse <= allowed; });
  std::ostringstream why;
  why << std::setprecision(3);
  if (felt) {
    why << "no law stays within the JND of " << limit << " N (at the root mean square force of " << force_rms
        << " N) on held-out data; " << chosen->model << " with " << chosen->cv_rmse
        << " N has the fewest parameters (" << chosen->free_parameters << ") of those within "
        << std::lround(100.0 * (as_good_as_best - 1.0)) << " % of the best, " << best->model << " with "
        << best->cv_rmse << " N";
  } else {
    why << chosen->model << " has the fewest parameters (" << chosen->free_parameters
        << ") of the laws whose error on held-out data (" << chosen->cv_rmse << " N) stays within the JND of "
        << limit << " N (at the root mean square force of " << force_rms << " N)";
  }
  return {.model = chosen->model, .why = why.str()};
}

}  // namespace kerf::fitting

#include "profiles/profile.h"

#include <algorithm>
#include <cmath>

#include "infinite.h"
#include "profiles/ridge.h"

namespace kerf::fitting {
namespace {

constexpr double profile_step = 0.5;  ///< [standard errors]
constexpr int max_steps = 20;         ///< outwards, doubling after the first few

/// The first value outwards from the best where the deviation reaches a limit, between the two points around
/// it.
double crossing(const Profile& profile, double limit) {
  const auto best =
      std::find(profile.deviation.begin(), profile.deviation.end(), 0.0) - profile.deviation.begin();
  const std::ptrdiff_t outwards = limit < 0.0 ? -1 : 1;
  const auto count = static_cast<std::ptrdiff_t>(profile.value.size());
  for (std::ptrdiff_t i = best + outwards; i >= 0 && i < count; i += outwards) {
    const auto here = static_cast<std::size_t>(i);
    const auto before = static_cast<std::size_t>(i - outwards);
    if (std::abs(profile.deviation[here]) < std::abs(limit)) continue;
    const double share =
        (limit - profile.deviation[before]) / (profile.deviation[here] - profile.deviation[before]);
    return profile.value[before] + share * (profile.value[here] - profile.value[before]);
  }
  return limit < 0.0 ? -infinite : infinite;
}

}  // namespace

std::vector<Profile> profiles_of(const Problem& problem, const Samples& samples, const Weights& weights,
                                 const Values& best, const RobustLoss& loss, const Uncertainty& uncertainty,
                                 const std::vector<std::string>& names) {
  const LawObjective whole(problem, samples, weights, best, loss);
  const Eigen::VectorXd at = coordinates_of(problem, best);
  const auto coordinates = problem.all();
  const Bounds bounds = problem.bounds();
  const Elsewhere elsewhere(problem, whole);
  Sums sums;
  if (!whole.evaluate(at, sums)) return {};
  std::vector<Profile> profiles;
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const auto index = static_cast<std::size_t>(k);
    const auto& info = problem.parameters[coordinates[index].parameter];
    Profile profile{.parameter = names[index]};
    const double error = uncertainty.determined[index] ? std::sqrt(uncertainty.covariance(k, k)) : 1.0;
    const double inverse = solve_normal(sums.normal, Eigen::VectorXd::Unit(at.size(), k))[k];
    const double unit = error * error / std::max(inverse, 1e-300);  // S rises by this in one standard error
    const auto limit = uncertainty.quantile[index];
    std::vector<std::pair<double, double>> points{{at[k], 0.0}};
    Ridge ridge(whole, bounds, at, k, sums.squares, unit, elsewhere);
    for (const double side : {-1.0, 1.0}) {
      ridge.begin_anew();
      double away = 0.0;
      for (int i = 0; i < max_steps; ++i) {
        away += i < 8 ? profile_step : profile_step * std::ldexp(1.0, i - 8);
        const double value = at[k] + side * away * error;
        if (value < bounds.lower[k] || value > bounds.upper[k]) break;
        const double deviation = side * ridge.deviation(value);
        if (!std::isfinite(deviation)) break;
        ridge.keep();
        points.emplace_back(value, deviation);
        if (std::abs(deviation) > 1.3 * limit) break;
      }
    }
    std::sort(points.begin(), points.end());
    for (const auto& [value, deviation] : points) {
      profile.value.push_back(value);
      profile.deviation.push_back(deviation);
    }
    profile.lower = from_search_scale(info, crossing(profile, -limit));
    profile.upper = from_search_scale(info, crossing(profile, limit));
    for (double& value : profile.value) value = from_search_scale(info, value);
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

}  // namespace kerf::fitting

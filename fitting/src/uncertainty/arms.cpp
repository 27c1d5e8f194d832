#include "uncertainty/arms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace kerf::fitting {

std::vector<Arm> arms_of(const Problem& problem) {
  const auto& beginnings = problem.facts().arm;
  std::vector<Arm> arms;
  if (beginnings.empty()) return arms;
  const std::string_view stiffness = *beginnings.begin();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    if (!problem.parameters[i].name.starts_with(stiffness)) continue;
    const std::string number = problem.parameters[i].name.substr(stiffness.size());
    Arm arm;
    for (const std::string_view beginning : beginnings) {
      const auto found = std::ranges::find(problem.parameters, std::string(beginning) + number,
                                           &models::ParameterInfo::name);
      arm.push_back(static_cast<std::size_t>(found - problem.parameters.begin()));
    }
    arms.push_back(std::move(arm));
  }
  return arms;
}

bool does_without(const Arm& arm, const Problem& problem, const Samples& samples, const Weights& weights,
                  const Solution& solution, const RobustLoss& loss, double independent_samples,
                  double confidence) {
  constexpr double noticeable = 1.05;  // of the sum of squares
  Problem less(problem);
  Values values(solution.values);
  for (const std::size_t parameter : arm) less.free[parameter] = false;
  for (auto& of_run : values) of_run[arm.front()] = problem.parameters[arm.front()].lower;
  const Solution without = search(less, samples, weights, values, {.loss = loss});
  const double rise = without.squares / std::max(solution.squares, std::numeric_limits<double>::min());
  return rise <= noticeable && independent_samples * std::log(rise) <= -2.0 * std::log(1.0 - confidence);
}

}  // namespace kerf::fitting

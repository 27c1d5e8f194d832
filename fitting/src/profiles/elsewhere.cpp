#include "profiles/elsewhere.h"

#include <algorithm>

#include "infinite.h"
#include "starts/scan.h"

namespace kerf::fitting {

Elsewhere::Elsewhere(const Problem& problem, const LawObjective& law) : problem_(problem), best_(law.near()) {
  const auto bent = scanned_parameter(problem);
  if (!bent || std::ranges::find(problem.own, true) != problem.own.end()) return;
  bent_ = *bent;
  const models::ParameterInfo& info = problem.parameters[bent_];
  std::vector<double> values = scanned_values(problem, law.samples());
  // A search begins at what a motion can tell; a limit may be missing because of what it cannot.
  constexpr int decades = 4;
  for (int i = 0; i < decades; ++i) values.push_back(10.0 * *std::ranges::max_element(values));
  for (const double value : values) {
    Scanned one{.values = std::vector<double>(problem.parameters.size(), 1.0), .sums = {}};
    one.values[bent_] = std::clamp(value, info.lower, info.upper);
    if (sums_of(problem, law.samples(), law.weights(), one.values, one.sums))
      scanned_.push_back(std::move(one));
  }
}

std::function<bool(const std::vector<double>& values, Sums& sums)> Elsewhere::sums_from(
    const Scanned& scanned) {
  return [&scanned](const std::vector<double>& values, Sums& sums) {
    const Eigen::Map<const Eigen::VectorXd> there(values.data(), scanned.sums.score.size());
    const Eigen::Map<const Eigen::VectorXd> from(scanned.values.data(), there.size());
    const Eigen::VectorXd change = there - from;
    const Eigen::VectorXd moved = scanned.sums.normal * change;
    sums = {.squares = scanned.sums.squares + 2.0 * change.dot(scanned.sums.score) + change.dot(moved),
            .score = scanned.sums.score + moved,
            .normal = scanned.sums.normal};
    return true;
  };
}

std::optional<Eigen::VectorXd> Elsewhere::least(Eigen::Index held, double value) const {
  const std::size_t parameter = problem_.all()[static_cast<std::size_t>(held)].parameter;
  if (parameter == bent_) return std::nullopt;
  std::vector<double> values(best_[0]);
  values[parameter] = from_search_scale(problem_.parameters[parameter], value);
  std::vector<bool> linear(problem_.free);
  linear[parameter] = linear[bent_] = false;
  // Without its bounds a family leaves no more, and costs less to look at.
  struct Looked {
    LinearFamily family;
    const Scanned* at;
    double no_less;
  };
  std::vector<Looked> all;
  for (const Scanned& scanned : scanned_) {
    values[bent_] = scanned.values[bent_];
    Looked looked{.family = family_of(problem_, values, linear), .at = &scanned, .no_less = 0.0};
    LinearFamily unbounded(looked.family);
    unbounded.bounds.lower.setConstant(-infinite);
    unbounded.bounds.upper.setConstant(infinite);
    looked.no_less = best_of_family(problem_, unbounded, sums_from(scanned)).sum_of_squares;
    all.push_back(std::move(looked));
  }
  std::ranges::sort(all, {}, &Looked::no_less);
  Start least{.values = {}, .sum_of_squares = infinite};
  for (const Looked& looked : all) {
    if (!(looked.no_less < least.sum_of_squares)) break;
    Start start = best_of_family(problem_, looked.family, sums_from(*looked.at));
    if (!start.values.empty() && start.sum_of_squares < least.sum_of_squares) least = std::move(start);
  }
  if (least.values.empty()) return std::nullopt;
  return coordinates_of(problem_, Values(problem_.runs, least.values));
}

}  // namespace kerf::fitting

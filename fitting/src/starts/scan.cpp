#include "starts/scan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "starts/foreign_starts.h"
#include "starts/prony.h"

namespace kerf::fitting {
namespace {

constexpr double small = 1e-6;  ///< of the whole, in place of a part that must be positive and is not
constexpr std::size_t starts_kept = 3;

std::vector<double> geometric(double first, double last, int steps) {
  std::vector<double> all;
  for (int i = 0; i < steps; ++i)
    all.push_back(first * std::pow(last / first, static_cast<double>(i) / (steps - 1)));
  return all;
}

std::size_t place_of(const Problem& problem, std::string_view name) {
  const auto found = std::find_if(problem.parameters.begin(), problem.parameters.end(),
                                  [&](const auto& info) { return info.name == name; });
  if (found == problem.parameters.end())
    throw std::logic_error("law '" + std::string(problem.model) +
                           "' has no parameter to be scanned: " + std::string(name));
  return static_cast<std::size_t>(found - problem.parameters.begin());
}

/// An arm is linear in its spring at a given relaxation time, along which the dashpot goes with it.
std::vector<LinearFamily> relaxations(const Problem& problem, const Samples& samples) {
  const auto dashpot = static_cast<Eigen::Index>(place_of(problem, problem.facts().scan.parameter));
  const auto spring = static_cast<Eigen::Index>(place_of(problem, problem.facts().scan.spring));
  const std::vector<double> unit(problem.parameters.size(), 1.0);
  std::vector<bool> linear(unit.size(), true);
  linear[static_cast<std::size_t>(dashpot)] = false;
  const double shortest = 2.0 * samples.median_period_s;
  std::vector<LinearFamily> families;
  for (const double time_s : geometric(shortest, std::max(samples.duration_s, 4.0 * shortest), 13)) {
    LinearFamily family = family_of(problem, unit, linear);
    const Eigen::Index column = spring - (dashpot < spring ? 1 : 0);
    family.base[dashpot] = 0.0;
    family.directions(dashpot, column) = time_s;
    families.push_back(std::move(family));
  }
  return families;
}

double option(const Problem& problem, std::string_view name) {
  const auto given = problem.law_options.find(name);
  if (given != problem.law_options.end()) return std::get<double>(given->second);
  for (const models::OptionInfo& info : models::Law::options(problem.model)) {
    if (info.name == name) return std::get<double>(info.standard);
  }
  return 0.0;
}

double unit_of(const Problem& problem, const Samples& samples) {
  const models::ScanFacts& scan = problem.facts().scan;
  switch (scan.unit) {
    case models::ScanUnit::one:
      break;
    case models::ScanUnit::depth:
      return std::max(samples.most, 1e-9);
    case models::ScanUnit::per_depth:
      return option(problem, scan.option) / std::max(samples.most, 1e-12);
    case models::ScanUnit::range:
      return samples.most - samples.least;
  }
  return 1.0;
}

/// One parameter takes one value after another; every other is linear.
std::vector<LinearFamily> grid(const Problem& problem, const Samples& samples) {
  const std::size_t at = place_of(problem, problem.facts().scan.parameter);
  std::vector<double> unit(problem.parameters.size(), 1.0);
  std::vector<bool> linear(unit.size(), true);
  linear[at] = false;
  std::vector<LinearFamily> families;
  for (const double value : scanned_values(problem, samples)) {
    unit[at] = std::clamp(value, problem.parameters[at].lower, problem.parameters[at].upper);
    families.push_back(family_of(problem, unit, linear));
  }
  return families;
}

std::vector<LinearFamily> families_of(const Problem& problem, const Samples& samples,
                                      const Weights& weights) {
  if (const models::ForeignLaw* const foreign = models::foreign_law(problem.model))
    return foreign_families(problem, *foreign);
  switch (problem.facts().scan.over) {
    case models::Scan::values:
      return grid(problem, samples);
    case models::Scan::relaxation:
      return relaxations(problem, samples);
    case models::Scan::prony:
      return prony_families(problem, samples, weights);
    case models::Scan::nothing:
      break;
  }
  const std::size_t all = problem.parameters.size();
  return {family_of(problem, std::vector<double>(all, 1.0), std::vector<bool>(all, true))};
}

}  // namespace

std::optional<std::size_t> scanned_parameter(const Problem& problem) {
  const models::LawFacts& facts = problem.facts();
  if (facts.search != models::Search::descent || facts.scan.over != models::Scan::values) return std::nullopt;
  const std::size_t place = place_of(problem, facts.scan.parameter);
  if (!problem.free[place] || problem.own[place]) return std::nullopt;
  return place;
}

std::vector<double> scanned_values(const Problem& problem, const Samples& samples) {
  const models::ScanFacts& scan = problem.facts().scan;
  std::vector<double> values(scan.values.begin(), scan.values.end());
  for (double& value : values) value *= unit_of(problem, samples);
  return scan.steps == 0 ? values : geometric(values.front(), values.back(), static_cast<int>(scan.steps));
}

LinearFamily family_of(const Problem& problem, const std::vector<double>& values,
                       const std::vector<bool>& linear) {
  const auto all = static_cast<Eigen::Index>(values.size());
  const auto count = static_cast<Eigen::Index>(std::count(linear.begin(), linear.end(), true));
  LinearFamily family{
      .base = Eigen::VectorXd::Zero(all), .directions = Eigen::MatrixXd::Zero(all, count), .bounds = {}};
  family.bounds = {.lower = Eigen::VectorXd(count), .upper = Eigen::VectorXd(count)};
  Eigen::Index next = 0;
  for (Eigen::Index i = 0; i < all; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!linear[at]) {
      family.base[i] = values[at];
      continue;
    }
    family.directions(i, next) = 1.0;
    family.bounds.lower[next] =
        problem.parameters[at].scale == models::Scale::logarithmic ? 0.0 : problem.parameters[at].lower;
    family.bounds.upper[next] = problem.parameters[at].upper;
    ++next;
  }
  return family;
}

bool sums_of(const Problem& problem, const Samples& samples, const Weights& weights,
             const std::vector<double>& values, Sums& sums) {
  const std::vector<double> slope(values.size(), 1.0);
  const LawPoint point{.values = values, .slope = slope, .options = problem.law_options};
  const auto all = static_cast<Eigen::Index>(values.size());
  sums = {.squares = 0.0, .score = Eigen::VectorXd::Zero(all), .normal = Eigen::MatrixXd::Zero(all, all)};
  for (std::size_t run = 0; run < samples.runs.size(); ++run) {
    Sums part;
    if (!kernel_of(problem.model).sums(point, view_of(samples, weights, run), {}, part)) return false;
    sums.squares += part.squares;
    sums.score += part.score;
    sums.normal += part.normal;
  }
  return true;
}

Start best_of_family(const Problem& problem, const Samples& samples, const Weights& weights,
                     const LinearFamily& family) {
  return best_of_family(problem, family, [&](const std::vector<double>& values, Sums& sums) {
    return sums_of(problem, samples, weights, values, sums);
  });
}

Start best_of_family(const Problem& problem, const LinearFamily& family,
                     const std::function<bool(const std::vector<double>& values, Sums& sums)>& sums_at) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(family.directions.cols());
  const Eigen::VectorXd unit = family.base + family.directions * ones;
  const std::vector<double> values(unit.begin(), unit.end());
  Start start{.values = {}, .sum_of_squares = std::numeric_limits<double>::infinity()};
  Sums all;
  if (!sums_at(values, all)) return start;
  if (!all.normal.allFinite() || !all.score.allFinite()) return start;
  if (ones.size() == 0) return {.values = values, .sum_of_squares = all.squares};
  const Eigen::MatrixXd normal = family.directions.transpose() * all.normal * family.directions;
  const Eigen::VectorXd score = family.directions.transpose() * all.score;
  const Eigen::VectorXd best = solve_bounded(normal, normal * ones - score, family.bounds);
  const Eigen::VectorXd change = best - ones;
  start.sum_of_squares = all.squares + 2.0 * change.dot(score) + change.dot(normal * change);
  const Eigen::VectorXd found = family.base + family.directions * best;
  start.values.assign(found.begin(), found.end());
  // What must be positive and is not at all begins at a small part of the largest of its kind.
  for (std::size_t i = 0; i < start.values.size(); ++i) {
    const auto& info = problem.parameters[i];
    double largest = 0.0;
    for (std::size_t k = 0; k < start.values.size(); ++k) {
      if (problem.parameters[k].quantity == info.quantity)
        largest = std::max(largest, std::abs(start.values[k]));
    }
    if (info.scale == models::Scale::logarithmic && family.base[static_cast<Eigen::Index>(i)] == 0.0) {
      start.values[i] = std::max(start.values[i], small * std::max(largest, 1e-6));
    }
    start.values[i] = std::clamp(start.values[i], info.lower, info.upper);
  }
  return start;
}

std::vector<std::vector<double>> starts_of(const Problem& problem, const Samples& samples,
                                           const Weights& weights) {
  std::vector<Start> starts;
  for (const LinearFamily& family : families_of(problem, samples, weights)) {
    starts.push_back(best_of_family(problem, samples, weights, family));
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.sum_of_squares < b.sum_of_squares; });
  std::vector<std::vector<double>> best;
  for (const Start& start : starts) {
    if (best.size() < starts_kept && !start.values.empty()) best.push_back(start.values);
  }
  return best;
}

}  // namespace kerf::fitting

#include "uncertainty/estimates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "infinite.h"
#include "tables.h"
#include "uncertainty/profile.h"
#include "uncertainty/statistics.h"
#include "uncertainty/uncertainty.h"

namespace kerf::fitting {
namespace {

/// Half the width of an interval is quantile times deviation, on the scale of the search.
struct Spread {
  double deviation = 0.0;
  double quantile = 0.0;
};

Estimate estimate_of(const models::ParameterInfo& info, double value, const Spread& spread) {
  const bool logarithmic = info.scale == models::Scale::logarithmic;
  const double centre = to_search_scale(info, value);
  const double half = spread.deviation > 0.0 ? spread.quantile * spread.deviation : 0.0;
  Estimate estimate{.info = info,
                    .value = value,
                    .std_error = logarithmic ? value * spread.deviation : spread.deviation,
                    .lower = from_search_scale(info, centre - half),
                    .upper = from_search_scale(info, centre + half)};
  if (std::isfinite(half)) {  // no further than the law itself
    estimate.lower = std::max(estimate.lower, std::min(info.lower, value));
    estimate.upper = std::min(estimate.upper, std::max(info.upper, value));
  }
  return estimate;
}

bool at_bound(const models::ParameterInfo& info, double value) {
  const double margin = info.scale == models::Scale::logarithmic ? 1.001 : 1.0;
  return value <= info.lower * (info.lower > 0.0 ? margin : 1.0) ||
         value >= info.upper / (info.upper > 0.0 ? margin : 1.0);
}

/// What is not known of parameters, and what is said of it.
struct Unknown {
  std::vector<std::string> names;
  std::string warning;
};

/// Parameters of an arm of a law, by their places; the first is its stiffness.
using Arm = std::vector<std::size_t>;

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

/// Whether a law without this arm, the rest fitted anew, leaves no more than chance would have it: twice the
/// logarithm of the ratio of the likelihoods, by as many samples as the residuals are worth, against
/// chi-squared of the arm's two parameters. Where both misfit, their residuals are worth next to no samples:
/// there it is the share that the arm explains that counts.
constexpr double noticeable = 1.05;  // of the sum of squares
bool does_without(const Arm& arm, const Problem& problem, const Samples& samples, const Weights& weights,
                  const Solution& solution, const RobustLoss& loss, const FitResult& result,
                  double confidence) {
  Problem less(problem);
  Values values(solution.values);
  for (const std::size_t parameter : arm) less.free[parameter] = false;
  for (auto& of_run : values) of_run[arm.front()] = problem.parameters[arm.front()].lower;
  const Solution without = search(less, samples, weights, values, {.loss = loss});
  const double rise = without.squares / std::max(solution.squares, std::numeric_limits<double>::min());
  const double worth = static_cast<double>(result.samples) / std::max(1.0, result.correlation_time);
  return rise <= noticeable && worth * std::log(rise) <= -2.0 * std::log(1.0 - confidence);
}

/// What counts as a change of a coordinate as large as itself.
double scale_of(const models::ParameterInfo& info, double value, double force_rms, double column_rms) {
  if (info.scale == models::Scale::logarithmic) return 1.0;
  const double by_force = column_rms > 0.0 ? force_rms / column_rms : 1.0;
  return std::max(std::abs(value), 1e-3 * by_force);
}

double rms(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, values.size())));
}

/// The rows that count, times the roots of their weights.
Linearisation linearisation_of(const LawObjective& objective, const Eigen::VectorXd& at,
                               const Samples& samples, const Weights& weights, const RobustLoss& loss) {
  Linearisation all;
  if (!objective.rows(at, all.residuals, all.jacobian)) all.jacobian.setZero();
  Eigen::Index kept = 0;
  for (const Run& run : samples.runs) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (!(weights[i] > 0.0)) continue;
      const auto row = static_cast<Eigen::Index>(i);
      const double residual = all.residuals[row] - samples.force[i];
      const double root = std::sqrt(weights[i] * loss(weights[i] * residual * residual).slope);
      all.residuals[kept] = root * residual;
      for (Eigen::Index k = 0; k < all.jacobian.cols(); ++k)
        all.jacobian(kept, k) = root * all.jacobian(row, k);
      ++kept;
    }
    all.run_ends.push_back(static_cast<std::size_t>(kept));
  }
  if (kept < all.residuals.size()) {
    all.residuals.conservativeResize(kept);
    all.jacobian.conservativeResize(kept, Eigen::NoChange);
  }
  return all;
}

/// The values that the coordinates of a problem have.
std::vector<double> searched_values(const Problem& problem, const Solution& solution) {
  std::vector<double> values;
  for (const auto& [parameter, run] : problem.all()) {
    values.push_back(solution.values[run == Estimate::shared ? 0 : run][parameter]);
  }
  return values;
}

Uncertainty as_of_residuals(const LawObjective& objective, const Eigen::VectorXd& at, const Problem& problem,
                            const Solution& solution, const Samples& samples, const Weights& weights,
                            const RobustLoss& loss, double confidence) {
  Linearisation linear = linearisation_of(objective, at, samples, weights, loss);
  const double force_rms =
      rms(Eigen::Map<const Eigen::VectorXd>(samples.force.data(), static_cast<Eigen::Index>(samples.size())));
  const auto coordinates = problem.all();
  const auto values = searched_values(problem, solution);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    linear.scale.push_back(scale_of(problem.parameters[coordinates[k].parameter], values[k], force_rms,
                                    rms(linear.jacobian.col(static_cast<Eigen::Index>(k)))));
  }
  return uncertainty_of(linear, confidence);
}

/// s^2 (J'J)^-1, from the search's own sums where it searched the same coordinates.
Uncertainty as_of_white_noise(const LawObjective& objective, const Eigen::VectorXd& at,
                              const Solution& solution, const Weights& weights, double confidence) {
  const Eigen::Index p = at.size();
  Sums sums{.squares = solution.squares, .score = {}, .normal = solution.normal};
  bool known = sums.normal.cols() == p;
  if (!known) known = objective.evaluate(at, sums);
  const auto counted =
      static_cast<double>(std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0.0; }));
  const double degrees_of_freedom = std::max(1.0, counted - static_cast<double>(p));
  Uncertainty result;
  result.covariance.setZero(p, p);
  result.correlation = Eigen::MatrixXd::Identity(p, p);
  for (Eigen::Index k = 0; k < p && known; ++k) {
    result.covariance.col(k) =
        sums.squares / degrees_of_freedom * solve_normal(sums.normal, Eigen::VectorXd::Unit(p, k));
  }
  const Eigen::VectorXd error = result.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Eigen::Index k = 0; k < p; ++k) {
    result.determined.push_back(known && sums.normal(k, k) > 0.0);
    result.quantile.push_back(student_t(confidence, degrees_of_freedom));
    for (Eigen::Index j = 0; j < p; ++j) {
      if (j != k && error[j] * error[k] > 0.0)
        result.correlation(j, k) = result.covariance(j, k) / (error[j] * error[k]);
    }
  }
  result.effective_samples = counted;
  return result;
}

void estimate_tables(FitResult& result, const Problem& problem, const Samples& samples,
                     const Weights& weights, const Solution& solution, double confidence) {
  const auto errors = table_errors(problem, samples, weights, solution.values[0]);
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const Spread spread{errors[i].std_error, student_t(confidence, errors[i].degrees_of_freedom)};
    unknown += std::isfinite(errors[i].std_error) ? 0 : 1;
    result.parameters.push_back(estimate_of(problem.parameters[i], solution.values[0][i], spread));
  }
  if (unknown > 0) {
    result.warnings.push_back(std::to_string(unknown) + " of " + std::to_string(errors.size()) +
                              " points of the tables were visited once or never; they have no interval");
  }
  const auto force = rendered(problem, solution.values, samples);
  std::vector<double> left;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (weights[i] > 0.0) left.push_back(force[i] - samples.force[i]);
  }
  result.correlation_time = correlation_time(left);
}

}  // namespace

void estimate_parameters(FitResult& result, const Problem& problem, const Samples& samples,
                         const Weights& weights, const Solution& solution, const FitOptions& options,
                         const RobustLoss& loss) {
  if (problem.facts().search == models::Search::tables) {
    estimate_tables(result, problem, samples, weights, solution, options.confidence);
    return;
  }
  const auto value_of = [&](const Problem::Coordinate& c) {
    return solution.values[c.run == Estimate::shared ? 0 : c.run][c.parameter];
  };
  // What lies at the end of its range is held there: the others' intervals are those of the law without it.
  Problem inner(problem);
  std::vector<Unknown> unknowns;
  for (const auto& coordinate : problem.all()) {
    const auto& info = problem.parameters[coordinate.parameter];
    if (!at_bound(info, value_of(coordinate))) continue;
    if (inner.free[coordinate.parameter])
      unknowns.push_back({{info.name}, "'" + info.name + "' lies at the bound of its range: no interval"});
    inner.free[coordinate.parameter] = false;
  }
  const LawObjective objective(inner, samples, weights, solution.values, loss);
  const auto coordinates = inner.all();
  std::vector<Spread> spreads(coordinates.size());
  if (!coordinates.empty()) {
    const Eigen::VectorXd at = coordinates_of(inner, solution.values);
    const Uncertainty uncertainty =
        options.intervals == Intervals::white
            ? as_of_white_noise(objective, at, solution, weights, options.confidence)
            : as_of_residuals(objective, at, inner, solution, samples, weights, loss, options.confidence);
    std::vector<bool> logarithmic;
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      const auto& info = problem.parameters[coordinates[k].parameter];
      const auto diagonal = static_cast<Eigen::Index>(k);
      spreads[k] = {
          uncertainty.determined[k] ? std::sqrt(uncertainty.covariance(diagonal, diagonal)) : infinite,
          uncertainty.quantile[k]};
      std::string name = info.name;
      if (coordinates[k].run != Estimate::shared)
        name += " of recording " + std::to_string(coordinates[k].run + 1);
      result.searched.push_back(name);
      logarithmic.push_back(info.scale == models::Scale::logarithmic);
    }
    result.correlation.assign(uncertainty.correlation.data(),
                              uncertainty.correlation.data() + uncertainty.correlation.size());
    result.correlation_time = std::min(uncertainty.correlation_time, static_cast<double>(samples.size()));
    for (const UnidentifiableDirection& unidentifiable : uncertainty.unidentifiable) {
      std::vector<std::string> names;
      for (const auto& [place, share] : unidentifiable.parts) names.push_back(result.searched[place]);
      unknowns.push_back({std::move(names), describe(unidentifiable, result.searched, logarithmic)});
    }
    if (options.profile) {
      result.profiles =
          profiles_of(inner, samples, weights, solution.values, loss, uncertainty, result.searched);
    }
  }
  for (const Arm& arm : arms_of(problem)) {
    const auto is_of_the_arm = [&](const Unknown& unknown) {
      return std::ranges::any_of(arm, [&](std::size_t parameter) {
        return std::ranges::find(unknown.names, problem.parameters[parameter].name) != unknown.names.end();
      });
    };
    if (std::ranges::none_of(unknowns, is_of_the_arm) ||
        !does_without(arm, problem, samples, weights, solution, loss, result, options.confidence))
      continue;
    std::erase_if(unknowns, is_of_the_arm);
    ++result.undetermined_arms;
    result.warnings.push_back("the arm of '" + problem.parameters[arm.front()].name + "' and '" +
                              problem.parameters[arm.back()].name +
                              "' is not determined: the data do not tell this law from one without it");
  }
  for (Unknown& unknown : unknowns) result.warnings.push_back(std::move(unknown.warning));
  const auto spread_of = [&](std::size_t parameter, std::size_t run) {
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      if (coordinates[k].parameter == parameter &&
          (coordinates[k].run == Estimate::shared || coordinates[k].run == run)) {
        return spreads[k];
      }
    }
    return problem.free[parameter] ? Spread{infinite, 1.0} : Spread{};  // at its bound, or held
  };
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    for (std::size_t run = 0; run < (problem.own[i] ? problem.runs : 1); ++run) {
      Estimate estimate = estimate_of(problem.parameters[i], solution.values[run][i], spread_of(i, run));
      if (problem.own[i]) estimate.recording = run;
      (run == 0 ? result.parameters : result.others).push_back(std::move(estimate));
    }
  }
  if (const std::string_view note = problem.facts().held_note; !note.empty())
    result.warnings.emplace_back(note);
}

}  // namespace kerf::fitting

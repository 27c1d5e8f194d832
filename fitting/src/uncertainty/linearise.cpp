#include "uncertainty/linearise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "infinite.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

/// What counts as a change of a coordinate as large as itself: one that changes the forces by as much as
/// there are, where it is near zero. Whether it is told from zero is another question (limits.h).
double scale_of(const models::ParameterInfo& info, double value, double force_rms, double column_rms) {
  if (info.scale == models::Scale::logarithmic) return 1.0;
  return std::max(std::abs(value), column_rms > 0.0 ? force_rms / column_rms : 1.0);
}

double rms(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, values.size())));
}

/// What the forces of the rows that count change by if the penetration of each run is larger by one standard
/// error of its zero, by the difference over one either way; empty where all are exact.
Eigen::VectorXd change_by_contact(const LawObjective& objective, const Problem& problem,
                                  const Solution& solution) {
  const Samples& samples = objective.samples();
  if (std::ranges::all_of(samples.runs, [](const Run& run) { return run.contact_error == 0.0; })) return {};
  const auto moved = [&](double errors) {
    Samples there(samples);
    for (const Run& run : there.runs) {
      for (std::size_t i = run.begin; i < run.end; ++i)
        there.motion[i].penetration += errors * run.contact_error;
    }
    return rendered(problem, solution.values, there);
  };
  const std::vector<double> deeper = moved(1.0);
  const std::vector<double> higher = moved(-1.0);
  const Weights& weights = objective.weights();
  Eigen::VectorXd change(std::ranges::count_if(weights, [](double weight) { return weight != 0.0; }));
  Eigen::Index kept = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (weights[i] != 0.0) change[kept++] = 0.5 * (deeper[i] - higher[i]);
  }
  return change;
}

/// The rows that count, times the roots of their weights; `change` is what change_by_contact() gives.
Linearisation rows_of(const LawObjective& objective, const Eigen::VectorXd& at, const Samples& samples,
                      const Weights& weights, const RobustLoss& loss, Eigen::VectorXd change) {
  Linearisation all;
  all.contact_shift = std::move(change);
  if (!objective.rows(at, all.residuals, all.jacobian)) all.jacobian.setZero();
  Eigen::Index kept = 0;
  bool all_in_cycles = true;
  const bool as_they_are =
      loss.kind == Loss::squares && std::ranges::all_of(weights, [](double weight) { return weight == 1.0; });
  if (as_they_are && !samples.has_cycles) {
    all.residuals -= Eigen::Map<const Eigen::VectorXd>(samples.force.data(), all.residuals.size());
    for (const Run& run : samples.runs) all.run_ends.push_back(run.end);
    return all;
  }
  for (const Run& run : samples.runs) {
    std::uint32_t cycle = 0;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (weights[i] == 0.0) continue;
      if (const std::uint32_t here = samples.cycle[i]; here > 0 && here != cycle) {
        if (cycle > 0) all.cycle_ends.push_back(static_cast<std::size_t>(kept));
        cycle = here;  // what lies between two cycles belongs to the first
      }
      const double residual = all.residuals[kept] - samples.force[i];
      const bool as_it_is = weights[i] == 1.0 && loss.kind == Loss::squares;
      const double root =
          as_it_is ? 1.0 : std::sqrt(weights[i] * loss(weights[i] * residual * residual).slope);
      all.residuals[kept] = root * residual;
      if (!as_it_is) all.jacobian.row(kept) *= root;
      if (!as_it_is && all.contact_shift.size() > 0) all.contact_shift[kept] *= root;
      ++kept;
    }
    all.run_ends.push_back(static_cast<std::size_t>(kept));
    all.cycle_ends.push_back(static_cast<std::size_t>(kept));
    all_in_cycles = all_in_cycles && cycle > 0;
  }
  if (!all_in_cycles) all.cycle_ends.clear();
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

}  // namespace

Linearisation linearise(const LawObjective& objective, const Problem& problem, const Solution& solution,
                        const Samples& samples, const Weights& weights, const RobustLoss& loss) {
  Linearisation linear = rows_of(objective, coordinates_of(problem, solution.values), samples, weights, loss,
                                 change_by_contact(objective, problem, solution));
  const double force_rms =
      rms(Eigen::Map<const Eigen::VectorXd>(samples.force.data(), static_cast<Eigen::Index>(samples.size())));
  form_products(linear);
  const auto rows = static_cast<double>(std::max<Eigen::Index>(1, linear.jacobian.rows()));
  const auto coordinates = problem.all();
  const auto values = searched_values(problem, solution);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const auto place = static_cast<Eigen::Index>(k);
    const double column_rms = std::sqrt(linear.normal(place, place) / rows);
    linear.scale.push_back(
        scale_of(problem.parameters[coordinates[k].parameter], values[k], force_rms, column_rms));
  }
  return linear;
}

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
    result.degrees_of_freedom.push_back(degrees_of_freedom);
    result.quantile.push_back(student_t(confidence, degrees_of_freedom));
    for (Eigen::Index j = 0; j < p; ++j) {
      if (j != k && error[j] * error[k] > 0.0)
        result.correlation(j, k) = result.covariance(j, k) / (error[j] * error[k]);
    }
  }
  result.effective_samples = counted;
  return result;
}

}  // namespace kerf::fitting

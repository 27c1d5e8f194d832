#include "starts/arm_search.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "starts/arm_sums.h"
#include "starts/prony.h"

namespace kerf::fitting {
namespace {

const MinimiseOptions of_a_start{.iterations = 200, .function_tolerance = 1e-7};
constexpr int most_steps = 2000;
constexpr double rounding = 1e-14;  ///< of the force's squares: no sum leaves less
constexpr double agreed = 1e-6;     ///< of the squares that are left, between the law and its sums
constexpr double nearly = 1e-3;     ///< likewise, where they were expected to be the law's
constexpr double rounded = 1e-10;   ///< and of the force's

/// Sums of a law, with a column for each parameter times its slope.
Sums sums_of(const ArmProducts& products, const std::vector<double>& values, const Eigen::VectorXd& slope) {
  const std::size_t arms = (values.size() - 1) / 2;
  const Eigen::Index terms = products.series.terms();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(1 + terms);
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(1 + terms, static_cast<Eigen::Index>(values.size()));
  force[0] = values[0];
  by(0, 0) = slope[0];
  for (std::size_t arm = 0; arm < arms; ++arm) {
    const double stiffness = values[1 + arm];
    const double time_s = values[1 + arms + arm];
    const auto spring = static_cast<Eigen::Index>(1 + arm);
    const auto time = static_cast<Eigen::Index>(1 + arms + arm);
    const ArmSeries::At here = products.series.at(std::log(time_s));
    force.tail(terms) += stiffness * here.value;
    by.col(spring).tail(terms) = slope[spring] * here.value;
    by.col(time).tail(terms) = slope[time] * stiffness / time_s * here.slope;
  }
  const Eigen::VectorXd product = products.normal * force;
  const double left = products.squares - 2.0 * force.dot(products.right) + force.dot(product);
  return {.squares = std::max(left, rounding * products.squares),
          .score = by.transpose() * (product - products.right),
          .normal = by.transpose() * products.normal * by};
}

/// The sum of squares by the coordinates of a problem.
class ArmObjective final : public Objective {
 public:
  ArmObjective(const Problem& problem, const ArmProducts& products, std::vector<double> near)
      : problem_(problem), products_(products), near_{std::move(near)} {
    for (const Problem::Coordinate& one : problem.all())
      searched_.push_back(static_cast<Eigen::Index>(one.parameter));
  }
  [[nodiscard]] Eigen::Index size() const override { return static_cast<Eigen::Index>(searched_.size()); }

  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override {
    const std::vector<double> values = values_at(at)[0];
    Eigen::VectorXd slope = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (problem_.parameters[i].scale == models::Scale::logarithmic)
        slope[static_cast<Eigen::Index>(i)] = values[i];
    }
    const Sums all = sums_of(products_, values, slope);
    sums = {
        .squares = all.squares, .score = all.score(searched_), .normal = all.normal(searched_, searched_)};
    return true;
  }
  [[nodiscard]] Values values_at(const Eigen::VectorXd& at) const {
    return fitting::values_at(problem_, near_, at);
  }

 private:
  const Problem& problem_;
  const ArmProducts& products_;
  Values near_;
  std::vector<Eigen::Index> searched_;
};

/// The bounds of the problem, of times no further than the series holds.
Bounds bounds_of(const Problem& problem, const ArmSeries& series) {
  Bounds bounds = problem.bounds();
  Eigen::Index next = 0;
  const std::size_t arms = (problem.parameters.size() - 1) / 2;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    if (!problem.free[i]) continue;
    if (i > arms) {
      const auto limit = [&](double time_s) { return to_search_scale(problem.parameters[i], time_s); };
      bounds.lower[next] = std::max(bounds.lower[next], limit(series.shortest_s()));
      bounds.upper[next] = std::min(bounds.upper[next], limit(series.longest_s()));
    }
    ++next;
  }
  return bounds;
}

/// Goes on by sums from some values; they are then where these are least.
void descend_by_sums(const Problem& problem, const ArmProducts& products, const MinimiseOptions& options,
                     Solution& solution) {
  const ArmObjective objective(problem, products, solution.values[0]);
  const Minimum minimum = minimise(objective, coordinates_of(problem, solution.values),
                                   bounds_of(problem, products.series), options);
  solution.values = objective.values_at(minimum.at);
  solution.squares = minimum.sums.squares;
  solution.iterations += minimum.iterations;
}

std::vector<double> force_of(const Problem& problem, const Samples& samples,
                             const std::vector<double>& values) {
  return rendered(problem, Values(problem.runs, values), samples);
}

/// Where there is no force.
LetGo none_in(const std::vector<double>& force) {
  LetGo let_go;
  let_go.reserve(force.size());
  for (const double one : force) let_go.push_back(one == 0.0 ? 1 : 0);
  return let_go;
}

/// By sums the least is sought for the samples at which the law would push; it is run to see at which it
/// does; and so on until it leaves what its sums say. Whether it did, and at once.
bool follow_the_law(const Problem& problem, const Samples& samples, const Weights& weights,
                    const ArmSums& sums, const std::vector<bool>& folds, ArmProducts products, LetGo let_go,
                    const MinimiseOptions& options, Solution& solution) {
  double before = 0.0;
  bool sure = true;
  for (int round = 0;; ++round) {
    const std::vector<double> force = force_of(problem, samples, solution.values[0]);
    const double squares = squares_left(force, samples, weights);
    const double off = std::abs(squares - solution.squares);
    const auto within = [&](double share) {
      return off <= share * solution.squares + rounded * products.squares;
    };
    sure = sure && within(nearly);
    solution.squares = squares;
    if (within(agreed)) return sure;
    LetGo of_law = none_in(force);
    if (of_law == let_go || (round >= 2 && !(off < 0.5 * before))) return false;
    before = off;
    let_go = std::move(of_law);
    products = sums.of(folds, let_go);
    descend_by_sums(problem, products, options, solution);
  }
}

}  // namespace

LeastSums least_by_sums(const Problem& problem, const Samples& samples, const Weights& weights,
                        const ArmSums& sums, const LetGo& expected, double function_tolerance) {
  const auto folds = sums.folds_of(weights);
  if (!folds) return {};
  const ArmProducts products = sums.of(*folds, expected);
  if (!products.normal.allFinite()) return {};
  std::optional<Solution> least;
  int iterations = 0;
  const auto sums_at = [&](const std::vector<double>& values, Sums& all) {
    all = sums_of(products, values, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(values.size())));
    return true;
  };
  for (const LinearFamily& family : prony_families(problem, samples, products)) {
    Start start = best_of_family(problem, family, sums_at);
    if (start.values.empty()) continue;
    Solution found{.values = {std::move(start.values)}};
    descend_by_sums(problem, products, of_a_start, found);
    iterations += std::exchange(found.iterations, 0);
    if (!least || found.squares < least->squares) least = std::move(found);
  }
  if (!least) return {};
  const MinimiseOptions to_the_end{.iterations = most_steps, .function_tolerance = function_tolerance};
  descend_by_sums(problem, products, to_the_end, *least);
  const bool sure =
      follow_the_law(problem, samples, weights, sums, *folds, products, expected, to_the_end, *least);
  least->values = Values(problem.runs, least->values[0]);
  least->iterations += iterations;
  return {.least = std::move(least), .sure = sure};
}

LetGo slack(const Problem& problem, const Samples& samples) {
  constexpr double next_to_none = 0.02;  // of the largest
  LetGo let_go;
  for (const double force : samples.force)
    let_go.push_back(!pulls(problem) && force < next_to_none * samples.largest_force ? 1 : 0);
  return let_go;
}

LetGo let_go_of(const Problem& problem, const Samples& samples, const std::vector<double>& values) {
  return none_in(force_of(problem, samples, values));
}

}  // namespace kerf::fitting

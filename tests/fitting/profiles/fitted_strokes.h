#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "profiles/limits.h"
#include "profiles/separable.h"
#include "uncertainty/linearise.h"

namespace kerf::fitting {

/// Strokes to and fro about a depth, quicker ones on them, and the force of a law with noise; fitted by least
/// squares.
struct FittedStrokes {
  Samples samples;
  Weights weights;
  Problem problem;
  Solution solution;

  FittedStrokes(const std::string& model, const std::vector<double>& truth, const std::string& fitted_as,
                double noise_n, double quick_m = 0.005) {
    std::mt19937_64 random(8);
    std::normal_distribution<double> normal(0.0, 1.0);
    const models::Law law = models::Law::make(model, truth);
    models::Law::State state = law.initial_state();
    std::vector<double> time_s, penetration, velocity, force;
    for (int i = 0; i < 3000; ++i) {
      const double t = 1e-3 * i;
      time_s.push_back(t);
      penetration.push_back(0.02 + 0.012 * std::sin(9.0 * t) + quick_m * std::sin(31.0 * t));
      velocity.push_back(0.108 * std::cos(9.0 * t) + 31.0 * quick_m * std::cos(31.0 * t));
      force.push_back(law.step(state, models::Motion{penetration.back(), velocity.back()}, 1e-3).force +
                      noise_n * normal(random));
    }
    const Series series{
        .time_s = time_s, .penetration = penetration, .velocity = velocity, .force = force, .cycle = {}};
    samples = check_series(std::span(&series, 1), {});
    weights = all_of(samples);
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = i < 300 ? 0.0 : i < 1500 ? 2.5 : 1.0;  // some seen more closely, some not at all
    problem = make_problem(model_names.emplace_back(fitted_as), {}, samples, weights, Polish::thorough);
    solution = search(problem, samples, weights, {}, {});
  }
  [[nodiscard]] Eigen::VectorXd best() const { return coordinates_of(problem, solution.values); }
  [[nodiscard]] LawObjective objective() const { return {problem, samples, weights, solution.values}; }
  [[nodiscard]] Linearisation linear() const {
    return linearise(objective(), problem, solution, samples, weights, {});
  }
  [[nodiscard]] std::unique_ptr<const SeparableSums> sums(const LawObjective& objective) const {
    return SeparableSums::around(objective, problem, best(), linear().residuals);
  }

 private:
  inline static std::vector<std::string> model_names = [] {
    std::vector<std::string> names;
    names.reserve(100);  // a problem refers to its name
    return names;
  }();
};

/// The limits of a fit, with something that is asked for profiles in place of the law.
inline std::vector<Limits> limits(const FittedStrokes& strokes,
                                  const std::function<std::unique_ptr<const Objective>()>& cheaper) {
  const LawObjective objective = strokes.objective();
  const Linearisation linear = strokes.linear();
  const Uncertainty uncertainty = uncertainty_of(linear, 0.95);
  const Sums sums{.squares = linear.residuals.squaredNorm(), .score = linear.score, .normal = linear.normal};
  return limits_of(strokes.problem, objective, strokes.best(), sums, sums.normal, uncertainty, linear.scale,
                   1, cheaper);
}

}  // namespace kerf::fitting

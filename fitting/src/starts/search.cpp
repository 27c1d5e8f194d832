#include "starts/search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "segmented/segmented_law.h"
#include "starts/scan.h"
#include "starts/staged.h"
#include "tables.h"

namespace kerf::fitting {
namespace {

constexpr std::size_t thinned_samples = 2000;

Values for_all_runs(const Problem& problem, const std::vector<double>& values) {
  return Values(problem.runs, values);
}

Solution solve_from(const Problem& problem, const Samples& samples, const Weights& weights,
                    const Values& start, const SearchOptions& options) {
  const LawObjective objective(problem, samples, weights, start, options.loss);
  const Minimum minimum = minimise(objective, coordinates_of(problem, start), problem.bounds(),
                                   {.iterations = 50, .function_tolerance = options.function_tolerance});
  return {.values = objective.values_at(minimum.at),
          .converged = minimum.converged,
          .iterations = minimum.iterations,
          .message = minimum.message,
          .squares = minimum.sums.squares,
          .normal = minimum.sums.normal};
}

double squares_at(const Problem& problem, const Samples& samples, const Weights& weights,
                  const Values& values) {
  const auto force = rendered(problem, values, samples);
  double squares = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    squares += weights[i] * (force[i] - samples.force[i]) * (force[i] - samples.force[i]);
  }
  return squares;
}

/// The best end of several starts on a thinned series, which is where a search of all samples begins.
Solution begin_on_few(const Problem& problem, const Samples& samples, const Weights& weights) {
  const Samples few = thinned(samples, thinned_samples);
  const Weights light = thinned_weights(samples, weights, few);
  Solution best;
  best.message = "the data offer no start for a search";
  double least = 0.0;
  int iterations = 0;
  for (const auto& start : starts_of(problem, few, light)) {
    // A start this far above an end already found is not tried.
    if (!best.values.empty() && squares_at(problem, few, light, for_all_runs(problem, start)) > 10.0 * least)
      break;
    Solution solution = solve_from(problem, few, light, for_all_runs(problem, start),
                                   {.loss = {}, .function_tolerance = 1e-7});
    iterations += solution.iterations;
    const double squares = squares_at(problem, few, light, solution.values);
    if (best.values.empty() || squares < least) {
      best = std::move(solution);
      least = squares;
    }
  }
  best.iterations = iterations;
  return best;
}

/// @throws std::invalid_argument for a name that is no parameter of the law.
std::vector<bool> own_parameters(const Problem& problem, const std::vector<std::string>& names) {
  std::vector<bool> own(problem.parameters.size(), false);
  for (const std::string& name : names) {
    const auto found = std::find_if(problem.parameters.begin(), problem.parameters.end(),
                                    [&](const auto& info) { return info.name == name; });
    if (found == problem.parameters.end()) {
      throw std::invalid_argument("law '" + std::string(problem.model) + "' has no parameter '" + name +
                                  "' that each recording could have of its own");
    }
    own[static_cast<std::size_t>(found - problem.parameters.begin())] = true;
  }
  return own;
}

}  // namespace

Problem make_problem(std::string_view model, const FitOptions& given, const Samples& samples) {
  Problem problem{.model = model, .law_options = given.law_options, .runs = samples.runs.size()};
  models::Options& options = problem.law_options;
  if (model == "piecewise" || model == "recording") options.try_emplace("loop", samples.has_cycles);
  if (model == "recording") {
    options.try_emplace("points", 101.0);
    options.try_emplace("first", samples.least);
    options.try_emplace("last", samples.most);
  }
  if (model == "hunt_crossley") options.try_emplace("reference_depth", std::max(samples.most, 1e-9));
  if (is_staged(model)) prepare_staged(model, options, samples);
  if (model == "piecewise") {
    problem.breakpoints = given.breakpoints;
    problem.segmented_memory = given.segmented_memory;
    prepare_segments(options, given, samples);
  }
  problem.parameters = models::Law::parameters(model, options);
  problem.free.assign(problem.parameters.size(), true);
  problem.own = own_parameters(problem, given.per_recording);
  if (model == "piecewise") hold_knots(problem, !given.breakpoints.empty());
  if (is_staged(model)) hold_unsearched(problem);
  const bool differs = std::find(problem.own.begin(), problem.own.end(), true) != problem.own.end();
  if (differs && (model == "piecewise" || model == "recording" || is_staged(model))) {
    throw std::invalid_argument("law '" + std::string(model) +
                                "' is fitted to all recordings as one; it has no "
                                "parameters that each recording could have of its own");
  }
  return problem;
}

Solution search(const Problem& problem, const Samples& samples, const Weights& weights, const Values& near,
                const SearchOptions& options) {
  if (problem.model == "recording") return solve_tables(problem, samples, weights, options.loss);
  if (problem.model == "piecewise") return solve_segments(problem, samples, weights, options.loss);
  if (is_staged(problem.model)) return solve_staged(problem, samples, weights, near, options.loss);
  if (!near.empty()) return solve_from(problem, samples, weights, near, options);
  Solution start = begin_on_few(problem, samples, weights);
  if (start.values.empty()) return start;
  Solution solution = solve_from(problem, samples, weights, start.values, options);
  solution.iterations += start.iterations;
  return solution;
}

}  // namespace kerf::fitting

#include "starts/search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <kerf/models/foreign.h>

#include "fracture/fracture_fit.h"
#include "ruptures/rupture_fit.h"
#include "segmented/segmented_law.h"
#include "starts/arm_search.h"
#include "starts/arm_sums.h"
#include "starts/scan.h"
#include "starts/threshold.h"
#include "tables.h"

namespace kerf::fitting {
namespace {

/// How many samples a search begins on: ten while the tool goes through its range at its fastest, so that a
/// law with a memory is shown how the force builds up and fades; few strokes among long rests need many.
std::size_t enough_to_begin(const Samples& samples) {
  constexpr double fewest = 2000.0;
  constexpr double most = 200'000.0;
  constexpr double in_one_way = 10.0;
  const double ways = samples.fastest * samples.duration_s / std::max(samples.most - samples.least, 1e-12);
  return static_cast<std::size_t>(std::clamp(in_one_way * ways, fewest, most));
}

constexpr int max_iterations = 2000;

Values for_all_runs(const Problem& problem, const std::vector<double>& values) {
  return Values(problem.runs, values);
}

Solution solve_from(const Problem& problem, const Samples& samples, const Weights& weights,
                    const Values& start, const SearchOptions& options) {
  const LawObjective objective(problem, samples, weights, start, options.loss);
  const Minimum minimum =
      minimise(objective, coordinates_of(problem, start), problem.bounds(),
               {.iterations = max_iterations, .function_tolerance = options.function_tolerance});
  return {.values = objective.values_at(minimum.at),
          .converged = minimum.converged,
          .iterations = minimum.iterations,
          .message = minimum.message,
          .squares = minimum.sums.squares,
          .normal = minimum.sums.normal};
}

/// The best end of several starts.
Solution begin_on(const Problem& problem, const Samples& few, const Weights& light,
                  const std::vector<std::vector<double>>& starts) {
  Solution best;
  best.message = "the data offer no start for a search";
  double least = 0.0;
  int iterations = 0;
  for (const auto& start : starts) {
    // A start this far above an end already found is not tried.
    if (!best.values.empty() && squares_of(problem, few, light, for_all_runs(problem, start)) > 10.0 * least)
      break;
    Solution solution = solve_from(problem, few, light, for_all_runs(problem, start),
                                   {.loss = {}, .function_tolerance = 1e-7});
    iterations += solution.iterations;
    if (best.values.empty() || solution.squares < least) {
      best = std::move(solution);
      least = best.squares;
    }
  }
  best.iterations = iterations;
  return best;
}

/// On a thinned series, which is where a search of all samples begins: a law that follows the motion at once
/// is as well known from few samples as from all.
Solution begin_on_few(const Problem& problem, const Samples& samples, const Weights& weights) {
  const std::size_t enough = enough_to_begin(samples);
  if (samples.size() < 2 * enough)
    return begin_on(problem, samples, weights, starts_of(problem, samples, weights));
  const Samples few = thinned(samples, enough);
  const Weights light = thinned_weights(samples, weights, few);
  return begin_on(problem, few, light, starts_of(problem, few, light));
}

/// Where the sums of arms are least, if they are sure; else the best end from there and the starts of the law
/// itself.
Solution begin_by_sums(const Problem& problem, const Samples& few, const Weights& light, const ArmSums& sums,
                       const LetGo& expected, double function_tolerance, bool from_every_start) {
  LeastSums by_sums = least_by_sums(problem, few, light, sums, expected, function_tolerance);
  if (by_sums.sure && !from_every_start) return *std::move(by_sums.least);
  std::vector<std::vector<double>> starts = starts_of(problem, few, light);
  if (by_sums.least) starts.insert(starts.begin(), by_sums.least->values[0]);
  return begin_on(problem, few, light, starts);
}

/// The same of a law with a memory, which is not as well known from few samples: its shortest times would
/// fall between them. Shown all of them it is looked for from every start; shown some folds less it lets go
/// nearly where it does then.
Solution begin_with_arms(const Problem& problem, const Samples& samples, const Weights& weights,
                         double function_tolerance) {
  if (std::ranges::find(problem.own, true) != problem.own.end()) {
    const Samples few = thinned(samples, enough_for_arms);
    const Weights light = thinned_weights(samples, weights, few);
    return begin_on(problem, few, light, starts_of(problem, few, light));
  }
  const std::size_t arms = problem.parameters.size() / 2;
  const auto memory = problem.arm_memory ? problem.arm_memory : std::make_shared<ArmMemory>();
  const auto& [few, sums] = memory->once([&] {
    Samples those = thinned(samples, enough_for_arms);
    const Weights all = all_of(those);
    ArmSums made(problem, those, all, slack(problem, those));
    const LeastSums first = least_by_sums(problem, those, all, made, made.expected(), function_tolerance);
    if (first.least) made.expect(let_go_of(problem, those, first.least->values[0]));
    return ArmSamples{.few = std::move(those), .sums = std::move(made)};
  });
  const Weights light = thinned_weights(samples, weights, few);
  const bool all = light == all_of(few);
  Solution begun = begin_by_sums(problem, few, light, sums, memory->expected(arms), function_tolerance, all);
  if (all && !begun.values.empty()) memory->expect(arms, let_go_of(problem, few, begun.values[0]));
  return begun;
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

models::OptionValue taken_from(const Samples& samples, const models::DataOption& option) {
  constexpr double nothing = 1e-9;
  switch (option.from) {
    case models::From::number:
      break;
    case models::From::cycles:
      return samples.has_cycles;
    case models::From::first:
      return samples.least;
    case models::From::last:
      return samples.most;
    case models::From::depth:
      return std::max(samples.most, nothing);
    case models::From::speed:
      return std::max(samples.fastest, nothing);
    case models::From::contact:  // samples begin there; who has the axis gives its position
      break;
  }
  return option.number;
}

void hold(Problem& problem, std::string_view name) {
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    if (problem.parameters[i].name.starts_with(name)) problem.free[i] = false;
  }
}

}  // namespace

double squares_left(const std::vector<double>& force, const Samples& samples, const Weights& weights) {
  double squares = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i)
    squares += weights[i] * (force[i] - samples.force[i]) * (force[i] - samples.force[i]);
  return squares;
}

double squares_of(const Problem& problem, const Samples& samples, const Weights& weights,
                  const Values& values) {
  return squares_left(rendered(problem, values, samples), samples, weights);
}

Problem make_problem(std::string_view model, const FitOptions& given, const Samples& samples,
                     const Weights& seen, Polish polish) {
  Problem problem{.model = model, .law_options = given.law_options, .runs = samples.runs.size()};
  problem.polish = polish;
  const models::LawFacts& facts = problem.facts();
  models::Options& options = problem.law_options;
  for (const models::DataOption& option : facts.from_data) {
    if (option.from != models::From::contact)
      options.try_emplace(std::string(option.name), taken_from(samples, option));
  }
  const bool segmented = facts.search == models::Search::segments;
  if (segmented) {
    problem.breakpoints = given.breakpoints;
    prepare_segments(problem, given, samples, seen);
  }
  problem.parameters = models::Law::parameters(model, options);
  problem.free.assign(problem.parameters.size(), true);
  problem.own = own_parameters(problem, given.per_recording);
  if (segmented) hold_knots(problem, !given.breakpoints.empty());
  for (const std::string_view name : facts.held) hold(problem, name);
  const models::ForeignLaw* const foreign = models::foreign_law(model);
  for (std::size_t i = 0; foreign != nullptr && i < problem.free.size(); ++i)
    problem.free[i] = foreign->is_searched(i);
  const bool differs = std::find(problem.own.begin(), problem.own.end(), true) != problem.own.end();
  if (differs && facts.search != models::Search::descent) {
    throw std::invalid_argument("law '" + std::string(model) +
                                "' is fitted to all recordings as one; it has no "
                                "parameters that each recording could have of its own");
  }
  return problem;
}

Solution search(const Problem& problem, const Samples& samples, const Weights& weights, const Values& near,
                const SearchOptions& options) {
  switch (problem.facts().search) {
    case models::Search::tables:
      return solve_tables(problem, samples, weights, options.loss);
    case models::Search::segments:
      return solve_segments(problem, samples, weights, options.loss);
    case models::Search::threshold: {
      Solution trained = solve_threshold(problem, samples, weights);
      // One rule is linear. Of more, least squares on all samples would take seconds along valleys that
      // nobody feels.
      const bool one_rule = std::get<double>(problem.law_options.at("memberships")) == 1.0;
      if (!one_rule || trained.values.empty() || problem.polish == Polish::brief) return trained;
      Solution polished = solve_from(problem, samples, weights, trained.values, options);
      polished.iterations += trained.iterations;
      return polished;
    }
    case models::Search::fracture:
      return solve_fracture(problem, samples, weights, near, options);
    case models::Search::ruptures:
      return solve_ruptures(problem, samples, weights, options);
    case models::Search::descent:
    case models::Search::none:
    case models::Search::blade:
      break;
  }
  if (!near.empty()) return solve_from(problem, samples, weights, near, options);
  const bool has_arms = problem.facts().scan.over == models::Scan::prony;
  Solution start = has_arms ? begin_with_arms(problem, samples, weights, options.function_tolerance)
                            : begin_on_few(problem, samples, weights);
  if (start.values.empty()) return start;
  Solution solution = solve_from(problem, samples, weights, start.values, options);
  solution.iterations += start.iterations;
  return solution;
}

}  // namespace kerf::fitting

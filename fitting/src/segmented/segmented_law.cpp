#include "segmented/segmented_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <kerf/models/branch.h>
#include <kerf/models/piecewise.h>

#include "kerf/fitting/segmented.h"
#include "segmented/segmented_memory.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

constexpr int max_reweighings = 20;  ///< of a robust loss
constexpr double settled = 1e-9;

std::vector<double> positions(const Samples& samples) {
  std::vector<double> all;
  for (const models::Motion& motion : samples.motion) all.push_back(motion.penetration);
  return all;
}

/// What the curve leaves at each sample, as the law itself has it.
std::vector<double> residuals_of(const SegmentedCurve& curve, const Samples& samples,
                                 const std::vector<std::uint8_t>& branch) {
  models::Piecewise<double> law;
  law.knots = curve.knots.size();
  std::copy(curve.knots.begin(), curve.knots.end(), law.knot.begin());
  std::copy(curve.force.front().begin(), curve.force.front().end(), law.closing.begin());
  std::copy(curve.force.back().begin(), curve.force.back().end(), law.opening.begin());
  std::vector<double> left;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    left.push_back(law.branch_force(branch[i] == 0, samples.motion[i].penetration) - samples.force[i]);
  }
  return left;
}

/// The curves up to so many segments, remembered ones where there are.
std::vector<SegmentedCurve> curves_of(const Problem& problem, const Curve& points, std::size_t segments) {
  const SegmentedOptions options{.max_segments = segments,
                                 .fewest_points = problem.points_per_segment,
                                 .breakpoints = problem.breakpoints,
                                 .polish = problem.polish};
  if (!problem.breakpoints.empty() || !problem.segmented_memory || !problem.segmented_memory->covers(options))
    return fit_segments(points, options);
  std::vector<SegmentedCurve> curves = problem.segmented_memory->curves(points, options.polish);
  std::erase_if(curves, [&](const SegmentedCurve& curve) { return curve.segments() > segments; });
  return curves;
}

std::vector<double> of_those(std::span<const double> values, const Weights& seen) {
  std::vector<double> chosen;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (seen[i] > 0.0) chosen.push_back(values[i]);
  }
  return chosen;
}

double segments_in(const models::Options& options) {
  const auto given = options.find("segments");
  return given != options.end() ? std::get<double>(given->second) : 5.0;
}

}  // namespace

std::vector<std::uint8_t> branches(const Samples& samples, bool loop) {
  std::vector<std::uint8_t> branch(samples.size(), 0);
  if (!loop) return branch;
  const models::BranchSelector selector;
  for (const Run& run : samples.runs) {
    models::BranchSelector::State state;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      branch[i] = selector.step(state, samples.motion[i], samples.period_s[i]).closing ? 0 : 1;
    }
  }
  return branch;
}

void prepare_segments(Problem& problem, const FitOptions& options, const Samples& samples,
                      const Weights& seen) {
  problem.breakpoints = options.breakpoints;
  problem.points_per_segment = options.points_per_segment;
  problem.segmented_memory = options.segmented_memory;
  models::Options& law_options = problem.law_options;
  if (!options.breakpoints.empty()) {
    law_options["segments"] = static_cast<double>(options.breakpoints.size() + 1);
  }
  if (options.segments == CountBy::given || !options.breakpoints.empty()) return;
  constexpr std::size_t most = SegmentedOptions{}.max_segments;
  // The search of the law that follows finds these curves again.
  if (!problem.segmented_memory)
    problem.segmented_memory = remember_segments(most, options.points_per_segment);
  const bool loop = std::get<bool>(law_options.at("loop"));
  const auto branch = branches(samples, loop);
  const auto position = positions(samples);
  const auto curves =
      curves_of(problem,
                {.position = position,
                 .force = samples.force,
                 .weight = seen,
                 .branch = loop ? std::span<const std::uint8_t>(branch) : std::span<const std::uint8_t>()},
                most);
  std::size_t chosen = curves.size() - 1;
  if (options.segments == CountBy::bic) {
    const auto left = of_those(residuals_of(curves.back(), samples, branch), seen);
    chosen = choose_by_bic(curves, static_cast<double>(left.size()) / correlation_time(left));
  } else {
    chosen = fewest_within(curves, options.jnd.at(rms_of(of_those(samples.force, seen)))).value_or(chosen);
  }
  law_options["segments"] = static_cast<double>(curves[chosen].segments());
}

void hold_knots(Problem& problem, bool all) {
  const auto is_knot = [](const auto& info) { return info.name.starts_with("knot"); };
  const auto knots =
      static_cast<std::size_t>(std::count_if(problem.parameters.begin(), problem.parameters.end(), is_knot));
  for (std::size_t i = 0; i < knots; ++i) {
    if (all || i == 0 || i + 1 == knots) problem.free[i] = false;
  }
}

Solution solve_segments(const Problem& problem, const Samples& samples, const Weights& weights,
                        const RobustLoss& loss) {
  const bool loop = std::get<bool>(problem.law_options.at("loop"));
  const auto segments = static_cast<std::size_t>(segments_in(problem.law_options));
  const auto branch = branches(samples, loop);
  const auto position = positions(samples);
  Weights robust(weights);
  Solution solution;
  for (int round = 0; round < max_reweighings; ++round) {
    std::vector<SegmentedCurve> curves;
    try {
      const Curve points{
          .position = position,
          .force = samples.force,
          .weight = robust,
          .branch = loop ? std::span<const std::uint8_t>(branch) : std::span<const std::uint8_t>()};
      curves = curves_of(problem, points, segments);
    } catch (const std::invalid_argument& error) {
      solution.message = error.what();
    }
    if (curves.empty() || curves.back().segments() != segments) {
      if (solution.message.empty())
        solution.message = "too few samples, or too few on one branch, for as many segments";
      return solution;
    }
    const SegmentedCurve& curve = curves.back();
    std::vector<double> values = curve.knots;
    for (const auto& force : curve.force) values.insert(values.end(), force.begin(), force.end());
    solution.converged = curve.converged;
    solution.iterations += curve.iterations;
    solution.message = !curve.converged        ? "the breakpoints did not come to rest"
                       : curve.optimal_on_grid ? "global optimum on the grid, polished"
                                               : "polished";
    const Values last = std::exchange(solution.values, Values(problem.runs, values));
    if (loss.kind == Loss::squares) break;
    double moved = last.empty() ? 1.0 : 0.0;
    for (std::size_t i = 0; !last.empty() && i < values.size(); ++i) {
      moved = std::max(moved, std::abs(values[i] - last[0][i]) / (1e-12 + std::abs(values[i])));
    }
    if (moved < settled) break;
    const auto left = residuals_of(curve, samples, branch);
    for (std::size_t i = 0; i < left.size(); ++i)
      robust[i] = weights[i] * loss(weights[i] * left[i] * left[i]).slope;
  }
  return solution;
}

}  // namespace kerf::fitting

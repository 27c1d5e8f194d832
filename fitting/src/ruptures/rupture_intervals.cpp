#include "ruptures/rupture_intervals.h"

#include <algorithm>
#include <cmath>

#include "infinite.h"

namespace kerf::fitting {
namespace {

ElementValues element_of(const Solution& solution) {
  const std::vector<double>& values = solution.values[0];
  return {values[0], values[1], values[2]};
}

/// Of a law of one rule, or of rules that are all alike.
RuptureLine line_of(const Problem& problem, const Solution& solution) {
  RuptureLine line;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    if (problem.parameters[i].name.starts_with("per_speed")) line.per_speed = solution.values[0][i];
    if (problem.parameters[i].name.starts_with("constant")) line.constant = solution.values[0][i];
  }
  return line;
}

/// Goes out from the best value of one number of the line.
class LineProfile {
 public:
  LineProfile(const RuptureCell& cell, const InCell& best, std::optional<double> HeldLine::*which,
              double value, double unit, double quantile)
      : cell_(cell), best_(best), which_(which), value_(value), unit_(unit), most_(quantile * quantile) {}

  [[nodiscard]] Limits limits(double scale) const {
    Limits limits{.lower = end(-scale), .upper = end(scale), .by = IntervalBy::profile};
    if (std::isinf(limits.lower) && std::isinf(limits.upper)) limits.by = IntervalBy::none;
    return limits;
  }

 private:
  /// The last value that is looked at and ruled out; infinite where none is.
  [[nodiscard]] double end(double step) const {
    constexpr int most_steps = 20;
    constexpr int halves = 4;
    InCell inner = best_;
    double from = value_;
    double to = value_ + step;
    for (int i = 0; !is_out(to, inner); ++i, step *= 2.0) {
      if (i == most_steps) return step < 0.0 ? -infinite : infinite;
      from = to;
      to += step;
    }
    for (int i = 0; i < halves; ++i) {
      const double middle = 0.5 * (from + to);
      (is_out(middle, inner) ? to : from) = middle;
    }
    return to;
  }
  /// Goes on from `inner`, and leaves it where a value is not out of the question.
  [[nodiscard]] bool is_out(double value, InCell& inner) const {
    HeldLine held;
    held.*which_ = value;
    const InCell there = cell_.descend(inner.at, held, false, 1e-4);
    if (!there.is_within() || there.squares - best_.squares > most_ * unit_) return true;
    inner = there;
    return false;
  }

  const RuptureCell& cell_;
  const InCell& best_;
  std::optional<double> HeldLine::*which_;
  double value_, unit_, most_;
};

}  // namespace

BetweenRuptures::BetweenRuptures(const Problem& problem, const Samples& samples, const Weights& weights,
                                 const Solution& solution, const RobustLoss& loss)
    : data(problem, samples, weights, loss),
      line(line_of(problem, solution)),
      rows(broken_at(data, element_of(solution), line).rows),
      parts(data, rows),
      one_line(problem.coordinates() <= 5) {
  const ElementValues element = element_of(solution);
  at = Eigen::Vector3d(std::log(element[0]), std::log(element[1]), std::log(element[2]));
}

Solution BetweenRuptures::alone(const RobustLoss& loss) const {
  const std::vector<double> values{std::exp(at[0]), std::exp(at[1]), std::exp(at[2])};
  const LawObjective objective(parts.element, parts.samples, parts.weights,
                               Values(parts.element.runs, values), loss);
  const Minimum minimum =
      minimise(objective, coordinates_of(parts.element, Values(1, values)), parts.element.bounds());
  return {.values = objective.values_at(minimum.at),
          .converged = minimum.converged,
          .squares = minimum.sums.squares,
          .normal = minimum.sums.normal};
}

ByRuptures limits_by_ruptures(const BetweenRuptures& between, const RobustLoss& loss, double least,
                              const Uncertainty& uncertainty) {
  constexpr double rounding = 1e-12;  // of the forces' squares
  constexpr double much_more = 4.0;   // than an interval allows
  constexpr double no_doubt = 10.0;   // likewise: rows are taken for those that rupture
  double squares = 0.0;
  for (const double force : between.parts.samples.force) squares += force * force;
  const double unit = std::max(least, rounding * squares) / std::max(1.0, uncertainty.effective_samples);
  const double quantile = *std::ranges::max_element(uncertainty.quantile);
  ByRuptures result{.quantile = quantile};
  if (between.parts.points.ruptured.empty()) {
    result.doubt = "nothing ruptures";
    return result;
  }
  if (between.parts.element.coordinates() < between.at.size()) {
    result.doubt = "the element between ruptures lies at the bound of its range";
    return result;
  }
  const RuptureCell cell(between.parts, loss);
  const InCell best = cell.descend(between.at);
  const double rise = (best.squares - least) / unit;
  const double others = rise_of_other_rows(between.data, best.element(), between.rows) / unit;
  if (!best.is_within() || rise > much_more * quantile * quantile) {
    result.doubt =
        "no line over the speed has the forces at which the tissue ruptures above it and all others below";
  } else if (others < no_doubt * quantile * quantile) {
    result.doubt = "other rows may as well be those at which the tissue ruptures";
  }
  if (!result.doubt.empty() || !between.one_line) return result;
  constexpr double first_step = 0.02;
  const RuptureLine& line = between.line;
  double fastest = 0.0;
  double force = std::abs(line.constant);
  for (const std::size_t row : between.rows) {
    fastest = std::max(fastest, between.data.speed[row]);
    force = std::max(force, std::abs(line.per_speed * between.data.speed[row] + line.constant));
  }
  result.constant =
      LineProfile(cell, best, &HeldLine::constant, line.constant, unit, quantile).limits(first_step * force);
  if (fastest > 0.0)
    result.per_speed = LineProfile(cell, best, &HeldLine::per_speed, line.per_speed, unit, quantile)
                           .limits(first_step * force / fastest);
  return result;
}

}  // namespace kerf::fitting

#include "kerf/fitting/segmented.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "segmented/segmented_knots.h"
#include "segmented/segmented_line.h"
#include "segmented/segmented_polish.h"
#include "segmented/segmented_search.h"

namespace kerf::fitting {
namespace {

using segmented::Points;

void check(const SegmentedOptions& options, const Points& points) {
  const auto outside = [](std::size_t value, std::size_t least, std::size_t most) {
    return value < least || value > most;
  };
  if (outside(options.max_segments, 1, segmented::max_segments)) {
    segmented::refuse("the number of segments must be from 1 to " + std::to_string(segmented::max_segments));
  }
  if (outside(options.cells, 4, 1024)) segmented::refuse("the grid must have 4 to 1,024 cells");
  if (options.fewest_points < 1) segmented::refuse("a segment must have at least 1 point");
  for (std::size_t i = 0; i < points.branches.size(); ++i) {
    const std::size_t have = points.branches[i].size();
    if (have >= options.fewest_points) continue;
    const std::string where = points.branches.size() == 1 ? "" : i == 0 ? " while closing" : " while opening";
    segmented::refuse("a segment needs " + std::to_string(options.fewest_points) + " points; there are " +
                      std::to_string(have) + where);
  }
}

SegmentedCurve finished(const Points& points, const segmented::Polished& best) {
  SegmentedCurve curve;
  const auto forces = segmented::best_forces(points, best.knots);
  double error = 0.0;
  for (std::size_t branch = 0; branch < points.branches.size(); ++branch) {
    std::vector<double> force(
        forces.at_knot[branch].begin(),
        forces.at_knot[branch].begin() + static_cast<std::ptrdiff_t>(best.knots.size()));
    error += points.branches[branch].error(best.knots, force);
    for (double& value : force) value = points.middle + points.spread * value;
    curve.force.push_back(std::move(force));
  }
  for (const double knot : best.knots) curve.knots.push_back(points.position(knot));
  curve.points = points.count;
  curve.sum_of_squares = error * points.spread * points.spread;
  curve.rmse = std::sqrt(curve.sum_of_squares / points.weight);
  curve.converged = best.converged;
  curve.iterations = best.iterations;
  return curve;
}

/// What the polish left the same curve, but for rounding, keeps the smaller figure.
void never_worse(SegmentedCurve& curve, const SegmentedCurve& fewer, double rounding) {
  if (curve.sum_of_squares > fewer.sum_of_squares && curve.sum_of_squares < fewer.sum_of_squares + rounding) {
    curve.sum_of_squares = fewer.sum_of_squares;
    curve.rmse = fewer.rmse;
  }
}

double information(const SegmentedCurve& curve, double effective_points) {
  // Below a billionth of the force that it explains, an error is rounding and must not be rewarded.
  double largest = 0.0;
  for (const auto& forces : curve.force) {
    for (const double force : forces) largest = std::max(largest, std::abs(force));
  }
  const double least = std::max(1e-9 * largest, 1e-150);
  const double mean_square = std::max(curve.rmse * curve.rmse, least * least);
  return effective_points * std::log(mean_square) +
         static_cast<double>(curve.parameters() + 1) * std::log(effective_points);
}

std::vector<double> inner_knots(const Points& points, const std::vector<double>& breakpoints) {
  if (breakpoints.size() + 1 > segmented::max_segments) {
    segmented::refuse("at most " + std::to_string(segmented::max_segments - 1) + " breakpoints can be given");
  }
  std::vector<double> knots{0.0};
  for (const double breakpoint : breakpoints) {
    const double scaled = points.scaled(breakpoint);
    if (!(scaled > 0.0 && scaled < 1.0)) {
      segmented::refuse("breakpoint " + std::to_string(breakpoint) +
                        " must lie between the ends of the points, " + std::to_string(points.first) +
                        " and " + std::to_string(points.last));
    }
    if (!(scaled - knots.back() >= segmented::least_gap)) segmented::refuse("breakpoints must increase");
    knots.push_back(scaled);
  }
  if (!(1.0 - knots.back() >= segmented::least_gap))
    segmented::refuse("the last breakpoint is at the end of the points");
  knots.push_back(1.0);
  return knots;
}

SegmentedCurve by_hand(const Points& points, const std::vector<double>& breakpoints) {
  const auto knots = inner_knots(points, breakpoints);
  const auto forces = segmented::best_forces(points, knots);
  if (!forces.determined) {
    segmented::refuse(
        "with these breakpoints the points leave the force at a knot open; move them to where points are");
  }
  SegmentedCurve curve = finished(points, {.knots = knots, .error = forces.error});
  for (std::size_t i = 0; i < breakpoints.size(); ++i) curve.knots[i + 1] = breakpoints[i];
  curve.sum_of_squares_on_grid = curve.sum_of_squares;
  return curve;
}

}  // namespace

std::vector<SegmentedCurve> fit_segments(const Curve& curve, const SegmentedOptions& options) {
  const Points points(curve);
  check(options, points);
  std::vector<SegmentedCurve> curves;
  if (!options.breakpoints.empty()) {
    curves.push_back(by_hand(points, options.breakpoints));
  } else {
    const double rounding = 1e-12 * points.weight * points.spread * points.spread;
    for (const auto& found : segmented::search(points, options)) {
      SegmentedCurve next = finished(points, found.best);
      next.sum_of_squares_on_grid =
          std::max(next.sum_of_squares, found.error_on_grid * points.spread * points.spread);
      next.optimal_on_grid = found.optimal_on_grid;
      if (!curves.empty()) never_worse(next, curves.back(), rounding);
      curves.push_back(std::move(next));
    }
  }
  for (SegmentedCurve& each : curves) each.bic = information(each, static_cast<double>(each.points));
  return curves;
}

std::size_t choose_by_bic(std::span<const SegmentedCurve> curves, double effective_points) {
  if (curves.empty()) segmented::refuse("there are no curves to choose from");
  if (!(effective_points >= 0.0))
    segmented::refuse("the effective number of points must be positive, or 0 for all");
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double points = effective_points > 0.0 ? effective_points : static_cast<double>(curves[i].points);
    const double bic = information(curves[i], points);
    if (bic < least) {
      least = bic;
      best = i;
    }
  }
  return best;
}

std::optional<std::size_t> fewest_within(std::span<const SegmentedCurve> curves, double limit_n) {
  std::optional<std::size_t> fewest;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!(curves[i].rmse <= limit_n)) continue;
    if (!fewest || curves[i].segments() < curves[*fewest].segments()) fewest = i;
  }
  return fewest;
}

}  // namespace kerf::fitting

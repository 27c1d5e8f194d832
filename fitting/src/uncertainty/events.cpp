#include "uncertainty/events.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "infinite.h"
#include "starts/fracture_events.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;
using Coordinates = FractureCoordinates;

constexpr Index free_of_depth = 3;
constexpr double no_error = std::numeric_limits<double>::quiet_NaN();

/// One choice of the rows that break, the rest at its best.
struct RowChoice {
  Eigen::VectorXd at;
  FractureCell cell;
  double left = 0.0;  ///< deviation that is left of the quantile
};

/// Those that are not out of the question, and whether there is one that is at either end.
struct RowChoices {
  std::vector<RowChoice> all;
  bool depth_ends_below = true;
  bool depth_ends_above = true;
  bool crack_ends = true;  ///< at both
};

/// Derivatives of a coordinate's logarithm by amplitude, exponent and crack at one depth of yielding.
Eigen::Vector3d gradient_of(const Coordinates& coordinates, const Eigen::VectorXd& at, Index k) {
  const Eigen::Matrix4d slopes = coordinates.slopes(at);
  return {slopes(k, Coordinates::amplitude), slopes(k, Coordinates::exponent), slopes(k, Coordinates::crack)};
}

class ChoiceSearch {
 public:
  ChoiceSearch(const Problem& problem, const Samples& samples, const Weights& weights, const RobustLoss& loss,
               double least, double unit, double quantile)
      : problem_(problem),
        samples_(samples),
        coordinates_(problem),
        objective_(problem, samples, weights, loss),
        least_(least),
        unit_(unit),
        quantile_(quantile) {}

  [[nodiscard]] RowChoices around(const Eigen::VectorXd& best, bool crack_is_seen) const {
    RowChoices choices{.all = {{best, cell_at(best), quantile_}}};
    choices.depth_ends_below = go_out(choices.all, Coordinates::depth, -1.0);
    choices.depth_ends_above = go_out(choices.all, Coordinates::depth, 1.0);
    if (!crack_is_seen) return choices;
    const bool ends_below = go_out(choices.all, Coordinates::crack, -1.0);
    const bool ends_above = go_out(choices.all, Coordinates::crack, 1.0);
    choices.crack_ends = ends_below && ends_above;
    return choices;
  }

 private:
  static constexpr double beyond = 1e-9;  ///< an end, where a row breaks that did not

  [[nodiscard]] FractureCell cell_at(const Eigen::VectorXd& at) const {
    return cell_of(problem_, samples_, coordinates_.values(at));
  }
  [[nodiscard]] static double& end_of(RowChoice& choice, Index k, double way) {
    if (k == Coordinates::depth) return way < 0.0 ? choice.cell.depth_from : choice.cell.depth_to;
    return way < 0.0 ? choice.cell.crack_from : choice.cell.crack_to;
  }

  /// From the best one on in one direction, by steps that double; then back by halves to where it ends. False
  /// where it does not.
  [[nodiscard]] bool go_out(std::vector<RowChoice>& all, Index k, double way) const {
    constexpr int most_steps = 20;
    constexpr int most_halves = 6;
    RowChoice inner = all.front();
    double step = end_of(inner, k, 1.0) - end_of(inner, k, -1.0);
    double outer = end_of(inner, k, way) * (1.0 + way * beyond);
    for (int i = 0; true; ++i) {
      if (i == most_steps || !(outer > 0.0 && outer < 2.0 * samples_.most)) return false;
      const std::optional<RowChoice> next = tried(inner, k, outer);
      if (!next) break;
      all.push_back(inner = *next);
      outer = end_of(inner, k, way) * (1.0 + way * beyond) + way * step;
      step *= 2.0;
    }
    for (int i = 0; i < most_halves && way * (outer - end_of(inner, k, way)) > 1e-6 * outer; ++i) {
      const double middle = 0.5 * (outer + end_of(inner, k, way));
      if (const std::optional<RowChoice> next = tried(inner, k, middle)) {
        all.push_back(inner = *next);
      } else {
        outer = middle;
      }
    }
    double& last = end_of(all.back(), k, way);
    if (inner.at == all.back().at) last = way < 0.0 ? std::min(last, outer) : std::max(last, outer);
    return true;
  }

  /// None where the choice is out of the question.
  [[nodiscard]] std::optional<RowChoice> tried(const RowChoice& near, Index k, double value) const {
    constexpr int most_steps = 8;
    Eigen::VectorXd at = near.at;
    if (k == Coordinates::crack) at = near.cell.moved_to(at, value);
    at[k] = std::log(value);
    const FractureCell cell = cell_at(at);
    const CellObjective in_cell(objective_, cell);
    const Minimum minimum =
        descend_by_steps(in_cell, in_cell.inside(at), in_cell.bounds(coordinates_.bounds()), most_steps);
    const double rise = rise_of(minimum.sums.squares);
    if (!(rise < quantile_ * quantile_)) return std::nullopt;
    return RowChoice{in_cell.outside(minimum.at), cell, std::sqrt(quantile_ * quantile_ - rise)};
  }
  [[nodiscard]] double rise_of(double squares) const { return std::max(0.0, squares - least_) / unit_; }

  const Problem& problem_;
  const Samples& samples_;
  Coordinates coordinates_;
  FractureObjective objective_;
  double least_, unit_, quantile_;
};

bool any_is_whole(const RowChoice& choice) { return choice.cell.depth_from > 0.0; }
bool any_broke(const RowChoice& choice) { return std::isfinite(choice.cell.depth_to); }

/// The span of one coordinate over all choices, on the search scale.
struct Span {
  double lower = infinite;
  double upper = -infinite;
  void take(double middle_low, double middle_high, double half) {
    lower = std::min(lower, middle_low - half);
    upper = std::max(upper, middle_high + half);
  }
};

}  // namespace

ByEvents limits_by_events(const Problem& problem, const Samples& samples, const Weights& weights,
                          const Solution& solution, const RobustLoss& loss, const Linearisation& linear,
                          const Uncertainty& uncertainty, double confidence) {
  ByEvents result{.limits = std::vector<Limits>(Coordinates::count),
                  .std_error = std::vector<double>(Coordinates::count, no_error)};
  const Coordinates coordinates(problem);
  const Eigen::VectorXd best = coordinates.at(solution.values[0]);
  const Eigen::Matrix4d slopes = coordinates.slopes(best);
  Linearisation smooth{
      .residuals = linear.residuals, .run_ends = linear.run_ends, .cycle_ends = linear.cycle_ends};
  smooth.jacobian.resize(linear.jacobian.rows(), free_of_depth);
  smooth.jacobian << linear.jacobian * slopes.leftCols(2), linear.jacobian * slopes.rightCols(1);
  const Uncertainty known = uncertainty_of(smooth, confidence);
  if (!known.determined[0] || !known.determined[1]) return result;
  Eigen::Matrix3d covariance = known.covariance;
  const bool crack_known = known.determined[2];
  if (!crack_known) {
    covariance.row(2).setZero();
    covariance.col(2).setZero();
  }
  const double quantile = std::max(known.quantile[0], known.quantile[1]);
  const double least = linear.residuals.squaredNorm();
  const double unit = std::max(least / std::max(1.0, known.effective_samples), 1e-300);
  const bool crack_is_seen = crack_known && !uncertainty.determined[3];
  const RowChoices found =
      ChoiceSearch(problem, samples, weights, loss, least, unit, quantile).around(best, crack_is_seen);
  const std::vector<RowChoice>& choices = found.all;
  for (Index k = 0; k < Coordinates::count; ++k) {
    const auto place = static_cast<std::size_t>(k);
    const bool by_rows = k >= 2 && !uncertainty.determined[place] && (k == 2 || crack_is_seen);
    if (!by_rows && (k >= 2 || choices.size() == 1)) continue;
    Span span;
    for (const RowChoice& choice : choices) {
      double middle[] = {choice.at[k], choice.at[k]};
      double half = 0.0;
      for (const bool up : {false, true}) {
        Eigen::VectorXd end = choice.at;
        const auto [from, to] = choice.cell.depths_at(std::exp(choice.at[Coordinates::crack]));
        if (by_rows)
          end[Coordinates::depth] =
              std::log(up ? std::max(to, choice.cell.depth_to) : std::min(from, choice.cell.depth_from));
        const Eigen::Vector3d gradient = gradient_of(coordinates, end, k);
        if (by_rows) middle[up ? 1 : 0] = std::log(coordinates.values(end)[place]);
        if (std::isfinite(end[Coordinates::depth]))
          half = std::max(half, choice.left * std::sqrt(gradient.dot(covariance * gradient)));
      }
      span.take(middle[0], middle[1], half);
    }
    Limits& limits = result.limits[place];
    limits.by = IntervalBy::profile;
    const bool all_end = found.depth_ends_below && found.depth_ends_above && found.crack_ends;
    const bool crack_told = k == 2 || found.crack_ends;
    const bool whole_seen =
        by_rows ? crack_told && found.depth_ends_below && std::ranges::all_of(choices, any_is_whole)
                : all_end;
    const bool broke =
        by_rows ? crack_told && found.depth_ends_above && std::ranges::all_of(choices, any_broke) : all_end;
    if (whole_seen) limits.lower = std::exp(span.lower);
    if (broke) limits.upper = std::exp(span.upper);
    if (!whole_seen && !broke) limits.by = IntervalBy::none;
    const Eigen::Vector3d gradient = gradient_of(coordinates, best, k);
    const double width = whole_seen && broke ? (span.upper - span.lower) / quantile : infinite;
    const double error = std::sqrt(gradient.dot(covariance * gradient));
    result.std_error[place] = by_rows ? std::max(error, 0.5 * width) : error;
  }
  return result;
}

}  // namespace kerf::fitting

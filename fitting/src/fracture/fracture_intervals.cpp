#include "fracture/fracture_intervals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "fracture/fracture_cells.h"
#include "infinite.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;
using Coordinates = FractureCoordinates;

constexpr Index free_of_depth = 3;
constexpr double no_error = std::numeric_limits<double>::quiet_NaN();

/// One choice of the rows that break, the rest at its best.
struct RowChoice {
  Eigen::VectorXd at;
  FractureSides sides;  // of very many choices, each with its rows, memory would tell
  double left = 0.0;    ///< deviation that is left of the quantile
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
  ChoiceSearch(const FractureObjective& objective, double most_m, double least, double unit, double quantile)
      : coordinates_(objective.coordinates()),
        objective_(objective),
        most_m_(most_m),
        least_(least),
        unit_(unit),
        quantile_(quantile) {}

  [[nodiscard]] RowChoices around(const Eigen::VectorXd& best, bool crack_is_seen) const {
    RowChoices choices{.all = {{best, objective_.cell(best).sides, quantile_}}};
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

  [[nodiscard]] static double& end_of(RowChoice& choice, Index k, double way) {
    if (k == Coordinates::depth) return way < 0.0 ? choice.sides.depth_from : choice.sides.depth_to;
    return way < 0.0 ? choice.sides.crack_from : choice.sides.crack_to;
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
      if (i == most_steps || !(outer > 0.0 && outer < 2.0 * most_m_)) return false;
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
    if (k == Coordinates::crack) at = near.sides.moved_to(at, value);
    at[k] = std::log(value);
    FractureCell cell = objective_.cell(at);
    const Minimum minimum = least_in_cell(coordinates_, cell, at, most_steps);
    const double rise = rise_of(minimum.sums.squares);
    if (!(rise < quantile_ * quantile_)) return std::nullopt;
    return RowChoice{minimum.at, std::move(cell.sides), std::sqrt(quantile_ * quantile_ - rise)};
  }
  [[nodiscard]] double rise_of(double squares) const { return std::max(0.0, squares - least_) / unit_; }

  const Coordinates& coordinates_;
  const FractureObjective& objective_;
  double most_m_, least_, unit_, quantile_;
};

bool any_is_whole(const RowChoice& choice) { return choice.sides.depth_from > 0.0; }
bool any_broke(const RowChoice& choice) { return std::isfinite(choice.sides.depth_to); }

/// Between which logarithms a parameter lies; infinite: no limit.
struct Span {
  double lower = infinite;
  double upper = -infinite;
  void take(double low, double high) {
    lower = std::min(lower, low);
    upper = std::max(upper, high);
  }
  [[nodiscard]] bool holds(double value) const { return lower <= value && value <= upper; }
};

/// A minimum, and what is known about it.
struct Known {
  Eigen::VectorXd at;
  double squares;
  Eigen::Matrix3d covariance;  ///< of amplitude, exponent and crack; 0 of a crack that is not known
};

/// What the neighbourhood of a minimum leaves of each parameter.
struct Basin {
  std::array<Span, Coordinates::count> span;
  std::array<double, Coordinates::count> error{};  ///< on the search scale
  bool one_choice = true;
};

/// The span of a parameter over all choices of the rows that break.
Span span_over(const std::vector<RowChoice>& choices, const Coordinates& coordinates,
               const Eigen::Matrix3d& covariance, Index k, bool by_rows) {
  Span span;
  for (const RowChoice& choice : choices) {
    double middle[] = {0.0, 0.0};
    double half = 0.0;
    for (const bool up : {false, true}) {
      Eigen::VectorXd end = choice.at;
      const auto [from, to] = choice.sides.depths_at(std::exp(choice.at[Coordinates::crack]));
      if (by_rows)
        end[Coordinates::depth] =
            std::log(up ? std::max(to, choice.sides.depth_to) : std::min(from, choice.sides.depth_from));
      const Eigen::Vector3d gradient = gradient_of(coordinates, end, k);
      middle[up ? 1 : 0] = std::log(coordinates.values(end)[static_cast<std::size_t>(k)]);
      if (std::isfinite(end[Coordinates::depth]))
        half = std::max(half, choice.left * std::sqrt(gradient.dot(covariance * gradient)));
    }
    span.take(middle[0] - half, middle[1] + half);
  }
  return span;
}

/// By what all minima are judged: what the best one leaves.
struct Judge {
  double unit;      ///< of the sum of squares: what is left times its correlation time
  double quantile;  ///< t
  bool crack_is_seen;
  std::array<bool, Coordinates::count> by_rows;  ///< parameters that only the rows that break tell
};

class EventLimits {
 public:
  EventLimits(const Problem& problem, const Samples& samples, const Weights& weights, const RobustLoss& loss)
      : problem_(problem),
        samples_(samples),
        weights_(weights),
        objective_(problem, samples, weights, loss),
        coordinates_(objective_.coordinates()) {}

  [[nodiscard]] const Coordinates& coordinates() const { return coordinates_; }

  [[nodiscard]] Basin around(const Known& minimum, const Judge& judge) const {
    const RowChoices found =
        ChoiceSearch(objective_, samples_.most, minimum.squares, judge.unit, judge.quantile)
            .around(minimum.at, judge.crack_is_seen);
    const std::vector<RowChoice>& choices = found.all;
    Basin basin{.one_choice = choices.size() == 1};
    for (Index k = 0; k < Coordinates::count; ++k) {
      const auto place = static_cast<std::size_t>(k);
      const bool by_rows = judge.by_rows[place];
      Span& span = basin.span[place];
      span = span_over(choices, coordinates_, minimum.covariance, k, by_rows);
      const bool all_end = found.depth_ends_below && found.depth_ends_above && found.crack_ends;
      const bool crack_told = k == 2 || found.crack_ends;
      const bool whole_seen =
          by_rows ? crack_told && found.depth_ends_below && std::ranges::all_of(choices, any_is_whole)
                  : all_end;
      const bool broke =
          by_rows ? crack_told && found.depth_ends_above && std::ranges::all_of(choices, any_broke) : all_end;
      const Eigen::Vector3d gradient = gradient_of(coordinates_, minimum.at, k);
      const double width = whole_seen && broke ? (span.upper - span.lower) / judge.quantile : infinite;
      const double error = std::sqrt(gradient.dot(minimum.covariance * gradient));
      basin.error[place] = by_rows ? std::max(error, 0.5 * width) : error;
      if (!whole_seen) span.lower = -infinite;
      if (!broke) span.upper = infinite;
    }
    return basin;
  }

  /// The minimum near a rival; none where the best one is closer to the force.
  [[nodiscard]] std::optional<Known> as_good(const std::vector<double>& rival, const Known& best,
                                             const Judge& judge) const {
    constexpr int most_steps = 30;
    const Eigen::VectorXd start = coordinates_.at(rival);
    const FractureCell cell = objective_.cell(start);
    const Minimum minimum = least_in_cell(coordinates_, cell, start, most_steps);
    const double rise = minimum.sums.squares - best.squares;
    const double allowed = judge.quantile * judge.quantile * judge.unit +
                           2.0 * judge.quantile * std::sqrt(judge.unit * between(minimum.at, best.at));
    if (!(rise < allowed)) return std::nullopt;
    const Eigen::Index free[] = {Coordinates::amplitude, Coordinates::exponent, Coordinates::crack};
    const Eigen::MatrixXd normal = cell.rows.sums(coordinates_, minimum.at).normal(free, free);
    Known known{.at = minimum.at, .squares = minimum.sums.squares, .covariance = Eigen::Matrix3d::Zero()};
    for (Index k = 0; k < free_of_depth; ++k)  // nothing of a crack that is not known
      known.covariance.col(k) = judge.unit * solve_normal(normal, Eigen::VectorXd::Unit(free_of_depth, k));
    if (!known.covariance.allFinite()) return std::nullopt;
    return known;
  }

 private:
  /// Sum of squares between the forces of two laws.
  [[nodiscard]] double between(const Eigen::VectorXd& one, const Eigen::VectorXd& other) const {
    const auto force = [&](const Eigen::VectorXd& at) {
      return rendered(problem_, Values(problem_.runs, coordinates_.values(at)), samples_);
    };
    const std::vector<double> a = force(one);
    const std::vector<double> b = force(other);
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += weights_[i] * (a[i] - b[i]) * (a[i] - b[i]);
    return squares;
  }

  const Problem& problem_;
  const Samples& samples_;
  const Weights& weights_;
  FractureObjective objective_;
  const Coordinates& coordinates_;
};

/// Of the parameter that differs most.
std::string warning_of(const Problem& problem, const std::vector<double>& best,
                       const std::vector<std::vector<double>>& others) {
  std::size_t most = 0;
  double farthest = 0.0;
  for (const std::vector<double>& other : others) {
    for (std::size_t k = 0; k < Coordinates::count; ++k) {
      const double distance = std::abs(std::log(other[k] / best[k]));
      if (distance > farthest) most = k;
      farthest = std::max(farthest, distance);
    }
  }
  const auto written = [](double value) {
    std::ostringstream text;
    text.precision(3);
    text << value;
    return text.str();
  };
  std::set<std::string> may_be;
  for (const std::vector<double>& other : others) may_be.insert(written(other[most]));
  std::string text = "other choices of the samples that break explain the force as well: '" +
                     std::string(problem.parameters[most].name) + "' may be";
  for (const std::string& value : may_be) text += (value == *may_be.begin() ? " " : ", ") + value;
  return text + " instead of " + written(best[most]) + "; the intervals hold them all";
}

}  // namespace

ByEvents limits_by_events(const Problem& problem, const Samples& samples, const Weights& weights,
                          const Solution& solution, const RobustLoss& loss, const Linearisation& linear,
                          const Uncertainty& uncertainty, double confidence) {
  ByEvents result{.limits = std::vector<Limits>(Coordinates::count),
                  .std_error = std::vector<double>(Coordinates::count, no_error)};
  const EventLimits events(problem, samples, weights, loss);
  const std::vector<double>& values = solution.values[0];
  Known best{.at = events.coordinates().at(values), .squares = linear.residuals.squaredNorm()};
  const Eigen::Matrix4d slopes = events.coordinates().slopes(best.at);
  Linearisation smooth{
      .residuals = linear.residuals, .run_ends = linear.run_ends, .cycle_ends = linear.cycle_ends};
  smooth.jacobian.resize(linear.jacobian.rows(), free_of_depth);
  smooth.jacobian << linear.jacobian * slopes.leftCols(2), linear.jacobian * slopes.rightCols(1);
  const Uncertainty known = uncertainty_of(smooth, confidence);
  if (!known.determined[0] || !known.determined[1]) return result;
  best.covariance = known.covariance;
  const bool crack_known = known.determined[2];
  if (!crack_known) {
    best.covariance.row(2).setZero();
    best.covariance.col(2).setZero();
  }
  Judge judge{.unit = std::max(best.squares / std::max(1.0, known.effective_samples), 1e-300),
              .quantile = std::max(known.quantile[0], known.quantile[1]),
              .crack_is_seen = crack_known && !uncertainty.determined[3],
              .by_rows = {}};
  judge.by_rows = {false, false, !uncertainty.determined[2], judge.crack_is_seen};
  const Basin own = events.around(best, judge);
  Basin all = own;
  std::vector<std::vector<double>> others;
  for (const std::vector<double>& rival : solution.rivals) {
    const std::optional<Known> as_good = events.as_good(rival, best, judge);
    if (!as_good) continue;
    const Basin basin = events.around(*as_good, judge);
    std::vector<double> there = events.coordinates().values(as_good->at);
    bool is_new = false;
    for (std::size_t k = 0; k < all.span.size(); ++k) {
      is_new = is_new || !own.span[k].holds(std::log(there[k]));
      all.span[k].take(basin.span[k].lower, basin.span[k].upper);
    }
    if (is_new) others.push_back(std::move(there));
  }
  if (!others.empty()) result.warning = warning_of(problem, values, others);
  for (std::size_t k = 0; k < all.span.size(); ++k) {
    const bool by_events = judge.by_rows[k] || (k < 2 && !own.one_choice);
    if (others.empty() && !by_events) continue;
    Limits& limits = result.limits[k];
    const Span& span = all.span[k];
    const bool any = std::isfinite(span.lower) || std::isfinite(span.upper);
    limits.by = any ? IntervalBy::profile : IntervalBy::none;
    if (std::isfinite(span.lower)) limits.lower = std::exp(span.lower);
    if (std::isfinite(span.upper)) limits.upper = std::exp(span.upper);
    result.std_error[k] = own.error[k];
  }
  return result;
}

}  // namespace kerf::fitting

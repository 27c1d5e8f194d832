#include "fracture/fracture_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "infinite.h"

namespace kerf::fitting {
namespace {

/// How far depth and crack may go before a row changes sides.
class CellOfRows {
 public:
  explicit CellOfRows(double crack_m) : crack_(crack_m) {}

  void take(const FractureRow& row) {
    using Mode = FractureRow::Mode;
    if (row.mode == Mode::deformation) {
      double& deepest = at(deepest_whole_, row.moves, 0.0);
      deepest = std::max(deepest, row.depth);
      crack_below(row.depth, row.moves);
    } else if (row.mode == Mode::fracture) {
      double& first = at(first_that_breaks_, row.moves, infinite);
      first = std::min(first, row.depth);
      const double ahead = crack_ - row.depth;
      if (ahead > 0.0) {
        crack_above(-ahead, row.moves + 1.0);
      } else {
        crack_below(-ahead, row.moves + 1.0);
      }
    } else if (row.depth < 0.0) {
      crack_above(row.depth, row.moves);
    } else if (row.mode == Mode::cutting) {
      crack_below(row.depth, row.moves);
    }
  }
  [[nodiscard]] FractureCell cell(FractureRows rows) && {
    leave_a_depth();
    FractureSides sides{.depth_to = infinite,
                        .crack_from = crack_from_,
                        .crack_to = crack_to_,
                        .crack = crack_,
                        .deepest_whole = std::move(deepest_whole_),
                        .first_that_breaks = std::move(first_that_breaks_)};
    std::tie(sides.depth_from, sides.depth_to) = sides.depths_at(crack_);
    return {std::move(sides), std::move(rows)};
  }

 private:
  static double& at(std::vector<double>& depths, double moves, double none) {
    const auto place = static_cast<std::size_t>(moves);
    if (depths.size() <= place) depths.resize(place + 1, none);
    return depths[place];
  }
  /// What goes on by `moves` times what a crack is longer stays where it has to by less than this.
  void crack_below(double way, double moves) {
    if (moves > 0.0) crack_to_ = std::min(crack_to_, crack_ + way / moves);
  }
  void crack_above(double way, double moves) {
    if (moves > 0.0) crack_from_ = std::max(crack_from_, crack_ + way / moves);
  }
  /// Depths of whole rows stay below those that break: how much the crack may differ.
  void leave_a_depth() {
    for (std::size_t k = 0; k < deepest_whole_.size(); ++k) {
      for (std::size_t j = 0; j < first_that_breaks_.size(); ++j) {
        const double room = first_that_breaks_[j] - deepest_whole_[k];
        const double moves = static_cast<double>(j) - static_cast<double>(k);
        if (deepest_whole_[k] == 0.0 || std::isinf(room)) continue;
        crack_below(room, moves);
        crack_above(-room, -moves);
      }
    }
  }

  double crack_;
  double crack_from_ = 0.0;
  double crack_to_ = infinite;
  std::vector<double> deepest_whole_, first_that_breaks_;
};

}  // namespace

FractureObjective::FractureObjective(const Problem& problem, const Samples& samples, const Weights& weights,
                                     const RobustLoss& loss)
    : problem_(problem), samples_(samples), weights_(weights), loss_(loss), coordinates_(problem) {}

template <typename Take>
FractureRows FractureObjective::walked(const Eigen::VectorXd& at, Take&& take) const {
  const double depth = std::exp(at[FractureCoordinates::depth]);
  const double crack = std::exp(at[FractureCoordinates::crack]);
  FractureRows rows(loss_, crack, samples_.size());
  walk(problem_, samples_, depth, crack, [&](const FractureRow& row) {
    take(row);
    if (weights_[row.at] > 0.0) rows.add(row, samples_.force[row.at], weights_[row.at]);
  });
  rows.end();
  return rows;
}

FractureRows FractureObjective::rows(const Eigen::VectorXd& at) const {
  return walked(at, [](const FractureRow&) {});
}

bool FractureObjective::evaluate(const Eigen::VectorXd& at, Sums& sums) const {
  if (!coordinates_.admit(at)) return false;
  sums = rows(at).sums(coordinates_, at);
  return std::isfinite(sums.squares);
}

double FractureObjective::squares(const Eigen::VectorXd& at) const {
  Sums sums;
  return evaluate(at, sums) ? sums.squares : infinite;
}

FractureCell FractureObjective::cell(const Eigen::VectorXd& at) const {
  CellOfRows limits(std::exp(at[FractureCoordinates::crack]));
  FractureRows rows = walked(at, [&](const FractureRow& row) { limits.take(row); });
  return std::move(limits).cell(std::move(rows));
}

namespace {

/// A damped step that leaves alone what a bound holds against the way down, as far as the next bound.
Eigen::VectorXd step_to_a_bound(const Minimum& from, const Bounds& bounds, double damping) {
  std::vector<Eigen::Index> moving;
  for (Eigen::Index k = 0; k < from.at.size(); ++k) {
    const bool held = (from.at[k] <= bounds.lower[k] && from.sums.score[k] > 0.0) ||
                      (from.at[k] >= bounds.upper[k] && from.sums.score[k] < 0.0);
    if (!held) moving.push_back(k);
  }
  Eigen::VectorXd change = Eigen::VectorXd::Zero(from.at.size());
  if (moving.empty()) return change;
  Eigen::MatrixXd normal = from.sums.normal(moving, moving);
  normal.diagonal() *= 1.0 + damping;
  change(moving) = solve_normal(normal, -from.sums.score(moving));
  double share = 1.0;
  for (const Eigen::Index k : moving) {
    const double room = (change[k] < 0.0 ? bounds.lower[k] : bounds.upper[k]) - from.at[k];
    if (std::abs(change[k]) > std::abs(room)) share = std::min(share, room / change[k]);
  }
  return share * change;
}

}  // namespace

Minimum descend_by_steps(const Objective& objective, const Eigen::VectorXd& start, const Bounds& bounds,
                         int most_steps, double tolerance) {
  constexpr double easier = 0.2;
  constexpr double harder = 10.0;
  Minimum minimum{.at = start.cwiseMax(bounds.lower).cwiseMin(bounds.upper)};
  if (!objective.evaluate(minimum.at, minimum.sums)) {
    minimum.sums.squares = std::numeric_limits<double>::infinity();
    return minimum;
  }
  constexpr int enough = 2;  // one may have ended at a bound
  int small_gains = 0;
  double damping = 1e-3;
  Sums next;
  for (; minimum.iterations < most_steps; ++minimum.iterations) {
    const Eigen::VectorXd at = (minimum.at + step_to_a_bound(minimum, bounds, damping))
                                   .cwiseMax(bounds.lower)
                                   .cwiseMin(bounds.upper);
    if (!at.allFinite() || !objective.evaluate(at, next) || !(next.squares < minimum.sums.squares)) {
      if (damping > 1e6) break;
      damping *= harder;
      continue;
    }
    damping *= easier;
    const double gain = minimum.sums.squares - next.squares;
    minimum.at = at;
    minimum.sums = next;
    small_gains = gain < tolerance * next.squares ? small_gains + 1 : 0;
    if (small_gains == enough) break;
  }
  return minimum;
}

std::pair<double, double> FractureSides::depths_at(double length) const {
  const double longer = length - crack;
  double from = 0.0;
  double to = infinite;
  for (std::size_t k = 0; k < deepest_whole.size(); ++k) {
    if (deepest_whole[k] > 0.0) from = std::max(from, deepest_whole[k] - static_cast<double>(k) * longer);
  }
  for (std::size_t k = 0; k < first_that_breaks.size(); ++k)
    to = std::min(to, first_that_breaks[k] - static_cast<double>(k) * longer);
  return {from, to};
}

Eigen::VectorXd FractureSides::moved_to(Eigen::VectorXd at, double length) const {
  at[FractureCoordinates::crack] = std::log(length);
  const auto [from, to] = depths_at(length);
  const double depth = std::exp(at[FractureCoordinates::depth]);
  const bool stays = from < depth && depth < to;
  if (!stays && from < to && std::isfinite(to)) at[FractureCoordinates::depth] = std::log(0.5 * (from + to));
  return at;
}

namespace {

/// The depths of a cell that ends somewhere.
std::pair<double, double> ends_at(const FractureSides& sides, double length) {
  const auto [from, to] = sides.depths_at(length);
  if (std::isinf(to)) return {from, 2.0 * from};
  return {from > 0.0 ? from : 0.5 * to, to};
}

}  // namespace

bool CellObjective::evaluate(const Eigen::VectorXd& at, Sums& sums) const {
  constexpr double small = 1e-6;  // of the crack: ends move along straight lines
  const double crack = std::exp(at[FractureCoordinates::crack]);
  const auto [from, to] = ends_at(cell_.sides, crack);
  const auto [from_beyond, to_beyond] = ends_at(cell_.sides, (1.0 + small) * crack);
  if (!(from < to)) return false;
  const Eigen::VectorXd whole = outside(at);
  if (!coordinates_.admit(whole)) return false;
  sums = cell_.rows.sums(coordinates_, whole);
  const double share = at[FractureCoordinates::depth];
  const double depth = std::exp(whole[FractureCoordinates::depth]);
  Eigen::Matrix4d slopes = Eigen::Matrix4d::Identity();
  slopes(FractureCoordinates::depth, FractureCoordinates::depth) = (to - from) / depth;
  slopes(FractureCoordinates::depth, FractureCoordinates::crack) =
      ((1.0 - share) * (from_beyond - from) + share * (to_beyond - to)) / (small * depth);
  sums.score = slopes.transpose() * sums.score;
  sums.normal = slopes.transpose() * sums.normal * slopes;
  return true;
}

Eigen::VectorXd CellObjective::inside(Eigen::VectorXd at) const {
  const auto [from, to] = ends_at(cell_.sides, std::exp(at[FractureCoordinates::crack]));
  double& depth = at[FractureCoordinates::depth];
  depth = (std::exp(depth) - from) / (to - from);
  return at;
}
Eigen::VectorXd CellObjective::outside(Eigen::VectorXd at) const {
  const auto [from, to] = ends_at(cell_.sides, std::exp(at[FractureCoordinates::crack]));
  double& depth = at[FractureCoordinates::depth];
  depth = std::log(from + depth * (to - from));
  return at;
}

Bounds CellObjective::bounds() const {
  Bounds bounds = coordinates_.bounds();
  constexpr double off = 1e-6;  // of a cell: at its ends rows break that did not
  constexpr Eigen::Index depth = FractureCoordinates::depth;
  constexpr Eigen::Index crack = FractureCoordinates::crack;
  const double share =
      std::isfinite(cell_.sides.crack_to) ? off * (cell_.sides.crack_to - cell_.sides.crack_from) : 0.0;
  bounds.lower[depth] = off;
  bounds.upper[depth] = 1.0 - off;
  if (cell_.sides.crack_from > 0.0)
    bounds.lower[crack] = std::max(bounds.lower[crack], std::log(cell_.sides.crack_from + share));
  if (std::isfinite(cell_.sides.crack_to))
    bounds.upper[crack] = std::min(bounds.upper[crack], std::log(cell_.sides.crack_to - share));
  return bounds;
}

Minimum least_in_cell(const FractureCoordinates& coordinates, const FractureCell& cell,
                      const Eigen::VectorXd& start, int most_steps, double tolerance) {
  const CellObjective in_cell(coordinates, cell);
  Minimum minimum = descend_by_steps(in_cell, in_cell.inside(start), in_cell.bounds(), most_steps, tolerance);
  minimum.at = in_cell.outside(minimum.at);
  return minimum;
}

}  // namespace kerf::fitting

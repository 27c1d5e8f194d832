#include "starts/fracture_events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <variant>

#include <ceres/jet.h>

#include <kerf/models/fracture.h>

#include "infinite.h"

namespace kerf::fitting {
namespace {

double thickness_of(const Problem& problem) {
  constexpr double standard_m = 0.1;
  const auto given = problem.law_options.find("thickness");
  return given != problem.law_options.end() ? std::get<double>(given->second) : standard_m;
}

/// Narrows a cell by one row of a run.
class CellOfRows {
 public:
  using Length = ceres::Jet<double, 1>;  ///< with its derivative by the length of a crack
  using Law = models::Fracture<Length>;

  explicit CellOfRows(FractureCell& cell) : cell_(cell) {}

  /// The penetration of a row, the tip before it, and what the law made of it.
  void take(double x, const Length& tip, const Law::State& after) {
    const double depth = x - tip.a;
    const double moves = tip.v[0];
    if (after.mode == Law::Mode::deformation) {
      double& deepest = at(cell_.deepest_whole, moves, 0.0);
      deepest = std::max(deepest, depth);
      crack_below(depth, moves);
    } else if (after.mode == Law::Mode::fracture) {
      double& first = at(cell_.first_that_breaks, moves, infinite);
      first = std::min(first, depth);
      const double ahead = tip.a + cell_.crack - x;
      if (ahead > 0.0) {
        crack_above(-ahead, moves + 1.0);
      } else {
        crack_below(-ahead, moves + 1.0);
      }
    } else if (depth < 0.0) {
      crack_above(depth, moves);
    } else if (after.mode == Law::Mode::cutting) {
      crack_below(depth, moves);
    }
  }
  /// Depths of whole rows stay below those that break: how much the crack may differ.
  void leave_a_depth() {
    for (std::size_t k = 0; k < cell_.deepest_whole.size(); ++k) {
      for (std::size_t j = 0; j < cell_.first_that_breaks.size(); ++j) {
        const double room = cell_.first_that_breaks[j] - cell_.deepest_whole[k];
        const double moves = static_cast<double>(j) - static_cast<double>(k);
        if (cell_.deepest_whole[k] == 0.0 || std::isinf(room)) continue;
        crack_below(room, moves);
        crack_above(-room, -moves);
      }
    }
    std::tie(cell_.depth_from, cell_.depth_to) = cell_.depths_at(cell_.crack);
  }

 private:
  static double& at(std::vector<double>& depths, double moves, double none) {
    const auto place = static_cast<std::size_t>(std::lround(moves));
    if (depths.size() <= place) depths.resize(place + 1, none);
    return depths[place];
  }
  /// What goes on by `moves` times what a crack is longer stays where it has to by less than this.
  void crack_below(double way, double moves) {
    if (moves > 0.0) cell_.crack_to = std::min(cell_.crack_to, cell_.crack + way / moves);
  }
  void crack_above(double way, double moves) {
    if (moves > 0.0) cell_.crack_from = std::max(cell_.crack_from, cell_.crack + way / moves);
  }

  FractureCell& cell_;
};

}  // namespace

FractureCoordinates::FractureCoordinates(const Problem& problem)
    : problem_(problem), thickness_(thickness_of(problem)) {}

Eigen::VectorXd FractureCoordinates::at(const std::vector<double>& values) const {
  const auto law = models::Fracture<double>::make(values, problem_.law_options);
  return Eigen::Vector4d(std::log(law.amplitude), std::log(law.exponent), std::log(law.yield_depth()),
                         std::log(law.crack_of_a_fracture()));
}

std::vector<double> FractureCoordinates::values(const Eigen::VectorXd& at) const {
  constexpr std::size_t width = 4;
  constexpr double blade_width_m = 0.01;  // held: forces tell only its product with the toughness
  const double alpha = std::exp(at[amplitude]);
  const double beta = std::exp(at[exponent]);
  const double energy = alpha * thickness_ / beta * std::expm1(beta * std::exp(at[depth]) / thickness_);
  std::vector<double> all{alpha, beta, energy, energy / (std::exp(at[crack]) * blade_width_m), blade_width_m};
  for (std::size_t i = 0; i < width; ++i) {
    const models::ParameterInfo& info = problem_.parameters[i];
    all[i] = std::isfinite(all[i]) ? std::clamp(all[i], info.lower, info.upper) : info.upper;
  }
  return all;
}

Eigen::Matrix4d FractureCoordinates::slopes(const Eigen::VectorXd& at) const {
  const double growth = std::exp(at[exponent] + at[depth]) / thickness_;
  const double by_depth = growth > 1e-8 ? growth / -std::expm1(-growth) : 1.0;
  Eigen::Matrix4d slopes;
  slopes << 1.0, 0.0, 0.0, 0.0,            //
      0.0, 1.0, 0.0, 0.0,                  //
      1.0, by_depth - 1.0, by_depth, 0.0,  //
      1.0, by_depth - 1.0, by_depth, -1.0;
  return slopes;
}

Bounds FractureCoordinates::bounds() const {
  constexpr double shortest_m = 1e-9;
  constexpr double longest_m = 1e3;
  const auto log_of = [&](std::size_t i, bool upper) {
    return std::log(upper ? problem_.parameters[i].upper : problem_.parameters[i].lower);
  };
  return {
      .lower =
          Eigen::Vector4d(log_of(0, false), log_of(1, false), std::log(shortest_m), std::log(shortest_m)),
      .upper = Eigen::Vector4d(log_of(0, true), log_of(1, true), std::log(longest_m), std::log(longest_m))};
}

FractureObjective::FractureObjective(const Problem& problem, const Samples& samples, const Weights& weights,
                                     const RobustLoss& loss)
    : problem_(problem),
      samples_(samples),
      weights_(weights),
      loss_(loss),
      coordinates_(problem),
      whole_(problem, samples, weights, Values(problem.runs, coordinates_.values(Eigen::Vector4d::Zero())),
             loss) {}

bool FractureObjective::evaluate(const Eigen::VectorXd& at, Sums& sums) const {
  const std::vector<double> values = coordinates_.values(at);
  Sums whole;
  if (!whole_.evaluate(coordinates_of(problem_, Values(problem_.runs, values)), whole)) return false;
  const Eigen::Matrix4d slopes = coordinates_.slopes(at);
  sums.squares = whole.squares;
  sums.score = slopes.transpose() * whole.score;
  sums.normal = slopes.transpose() * whole.normal * slopes;
  return true;
}

double FractureObjective::squares(const Eigen::VectorXd& at) const {
  const auto force = rendered(problem_, Values(problem_.runs, coordinates_.values(at)), samples_);
  double squares = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    squares += loss_(weights_[i] * (force[i] - samples_.force[i]) * (force[i] - samples_.force[i])).rho;
  }
  return std::isfinite(squares) ? squares : infinite;
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
  Eigen::VectorXd step = Eigen::VectorXd::Zero(from.at.size());
  if (moving.empty()) return step;
  Eigen::MatrixXd normal = from.sums.normal(moving, moving);
  normal.diagonal() *= 1.0 + damping;
  step(moving) = solve_normal(normal, -from.sums.score(moving));
  double share = 1.0;
  for (const Eigen::Index k : moving) {
    const double room = (step[k] < 0.0 ? bounds.lower[k] : bounds.upper[k]) - from.at[k];
    if (std::abs(step[k]) > std::abs(room)) share = std::min(share, room / step[k]);
  }
  return share * step;
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

std::pair<double, double> FractureCell::depths_at(double length) const {
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

Eigen::VectorXd FractureCell::moved_to(Eigen::VectorXd at, double length) const {
  at[FractureCoordinates::crack] = std::log(length);
  const auto [from, to] = depths_at(length);
  const double depth = std::exp(at[FractureCoordinates::depth]);
  const bool stays = from < depth && depth < to;
  if (!stays && from < to && std::isfinite(to)) at[FractureCoordinates::depth] = std::log(0.5 * (from + to));
  return at;
}

FractureCell cell_of(const Problem& problem, const Samples& samples, const std::vector<double>& values) {
  const auto known = models::Fracture<double>::make(values, problem.law_options);
  FractureCell cell{.depth_to = infinite, .crack_to = infinite, .crack = known.crack_of_a_fracture()};
  CellOfRows rows(cell);
  std::vector<CellOfRows::Length> numbers(values.begin(), values.end());
  numbers[3].v[0] = -values[3] / cell.crack;  // of the toughness by the length
  const auto law = CellOfRows::Law::make(numbers, problem.law_options);
  for (const Run& run : samples.runs) {
    CellOfRows::Law::State state;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const CellOfRows::Length tip = state.surface;
      (void)law.step(state, samples.motion[i], samples.period_s[i]);
      rows.take(samples.motion[i].penetration, tip, state);
    }
  }
  rows.leave_a_depth();
  return cell;
}

namespace {

/// The depths of a cell that ends somewhere.
std::pair<double, double> ends_at(const FractureCell& cell, double length) {
  const auto [from, to] = cell.depths_at(length);
  if (std::isinf(to)) return {from, 2.0 * from};
  return {from > 0.0 ? from : 0.5 * to, to};
}

}  // namespace

bool CellObjective::evaluate(const Eigen::VectorXd& at, Sums& sums) const {
  constexpr double small = 1e-6;  // of the crack: ends move along straight lines
  const double crack = std::exp(at[FractureCoordinates::crack]);
  const auto [from, to] = ends_at(cell_, crack);
  const auto [from_beyond, to_beyond] = ends_at(cell_, (1.0 + small) * crack);
  if (!(from < to)) return false;
  const Eigen::VectorXd whole = outside(at);
  if (!objective_.evaluate(whole, sums)) return false;
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
  const auto [from, to] = ends_at(cell_, std::exp(at[FractureCoordinates::crack]));
  double& depth = at[FractureCoordinates::depth];
  depth = (std::exp(depth) - from) / (to - from);
  return at;
}
Eigen::VectorXd CellObjective::outside(Eigen::VectorXd at) const {
  const auto [from, to] = ends_at(cell_, std::exp(at[FractureCoordinates::crack]));
  double& depth = at[FractureCoordinates::depth];
  depth = std::log(from + depth * (to - from));
  return at;
}

Bounds CellObjective::bounds(Bounds bounds) const {
  constexpr double off = 1e-6;  // of a cell: at its ends rows break that did not
  constexpr Eigen::Index depth = FractureCoordinates::depth;
  constexpr Eigen::Index crack = FractureCoordinates::crack;
  const double share = std::isfinite(cell_.crack_to) ? off * (cell_.crack_to - cell_.crack_from) : 0.0;
  bounds.lower[depth] = off;
  bounds.upper[depth] = 1.0 - off;
  if (cell_.crack_from > 0.0)
    bounds.lower[crack] = std::max(bounds.lower[crack], std::log(cell_.crack_from + share));
  if (std::isfinite(cell_.crack_to))
    bounds.upper[crack] = std::min(bounds.upper[crack], std::log(cell_.crack_to - share));
  return bounds;
}

}  // namespace kerf::fitting

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kerf::fitting {

/// Points of a curve, in any order. All spans have one length, or none where they may be empty.
struct Curve {
  std::span<const double> position;      ///< x [m or rad]
  std::span<const double> force;         ///< [N]
  std::span<const double> weight;        ///< of the squared error, not negative; empty: 1
  std::span<const std::uint8_t> branch;  ///< 0 closing, 1 opening; empty: all on one branch
};

/// How far curves leave the grid on which they were found.
enum class Polish : std::uint8_t {
  none,
  brief,    ///< to the least error next to them: where an error is asked for, and not a curve
  thorough  ///< by all starts and over all kinks
};

struct SegmentedOptions {
  std::size_t max_segments = 12;    ///< 1 to 16
  std::size_t cells = 256;          ///< of the grid of the dynamic programming, 4 to 1024
  std::size_t fewest_points = 4;    ///< in a segment, on each branch, its ends included; at least 1
  std::vector<double> breakpoints;  ///< inner knots by hand: then these alone, and no search
  Polish polish = Polish::thorough;
};

/// A continuous piecewise-linear curve with the least sum of squares that was found.
struct SegmentedCurve {
  std::vector<double> knots;               ///< increasing; the first and the last are the ends of the points
  std::vector<std::vector<double>> force;  ///< at the knots [N], one set a branch (closing, opening)
  std::size_t points = 0;                  ///< of positive weight
  double sum_of_squares = 0.0;             ///< weighted [N^2]
  double sum_of_squares_on_grid = 0.0;     ///< before the polish [N^2]
  double rmse = 0.0;                       ///< root of the weighted mean square [N]
  double bic = 0.0;                        ///< n ln(RSS/n) + (p + 1) ln n, p of inner knots and forces
  bool optimal_on_grid = false;  ///< proven; a beam that was too narrow for a loop may leave it open
  bool converged = false;
  int iterations = 0;  ///< of the polish

  [[nodiscard]] std::size_t segments() const noexcept { return knots.size() - 1; }
  [[nodiscard]] std::size_t parameters() const noexcept {
    return knots.size() - 2 + force.size() * knots.size();
  }
};

/// Piecewise-linear curves, continuous at their knots, for every number of segments s from 1 on:
///
///     min over k_1 < ... < k_{s-1} and F of  sum_i w_i (F(x_i) - y_i)^2,   F linear between the knots
///
/// with k_0 and k_s at the ends of the points. Two branches share their knots and have forces of their own.
///
/// 1. On a grid of `cells` equal cells, dynamic programming under continuity. The least sum of squares of all
///    that lies before a knot is, as a function of the force y at that knot, a lower envelope of parabolas,
///
///        f_s(g, y) = min over g' < g, y' of  f_{s-1}(g', y') + SSE of the line from (g', y') to (g, y),
///
///    and only those on the envelope are kept: exact for one branch. With two branches a path is a sum of two
///    parabolas, and a path goes if another is nowhere worse where it could still win; of the rest the best
///    64 at a knot are kept. The result says whether that limit was ever met; if not, it is exact too. (Loops
///    on 12 cells, 1 to 5 segments: all 40 tried were the best of all choices of knots. On 256 cells the
///    limit is met from about 6 segments on.) Paths that cannot beat a curve made on the grid one
///    knot after the other, even if the rest were broken at its knots, go first.
/// 2. The knots leave the grid by variable projection (Ceres; the forces follow by least squares), and by the
///    same dynamic programming on the points around each knot, by turns until neither gains: between any two
///    points the sum of squares is smooth, at each it has a kink. Up to 50,000 positions these intervals and
///    kinks are also tried one by one around each knot, up to 2,000 for two neighbouring knots at once.
/// 3. Starts are the optimum on that grid, the one on a grid that follows the points, and the curves of one
///    segment more and less, so that more segments are never worse.
///
/// Only sums over stretches of the sorted points are used, so that beyond the sorting hardly anything depends
/// on their number. Numbers of segments that the points cannot carry are left out at the end.
///
/// Source: [Maidstone2019] (functional pruning for changes in slope); [GolubPereyra1973] (variable
/// projection); [Hudson1966] (kinks and joins between points).
/// @throws std::invalid_argument for spans of different lengths, numbers that are not finite, negative
/// weights,
///         a constant position, too few points on a branch, or breakpoints that do not lie in order inside.
[[nodiscard]] std::vector<SegmentedCurve> fit_segments(const Curve& curve,
                                                       const SegmentedOptions& options = {});

/// Where in the curves the least BIC is. Points that follow each other closely in time say less than as many
/// independent ones: give the effective number, or 0 for the number of points.
/// @throws std::invalid_argument if there are no curves, or for a negative number.
[[nodiscard]] std::size_t choose_by_bic(std::span<const SegmentedCurve> curves,
                                        double effective_points = 0.0);

/// Where in the curves the fewest segments are whose root mean square error is at most a limit, such as
/// Jnd::at the root mean square force; nothing if there is none.
[[nodiscard]] std::optional<std::size_t> fewest_within(std::span<const SegmentedCurve> curves,
                                                       double limit_n);

}  // namespace kerf::fitting

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <Eigen/Cholesky>

#include "segmented/segmented_knots.h"
#include "segmented/segmented_polish.h"

namespace kerf::fitting::segmented {
namespace {

constexpr double hop_gain = 1e-12;           ///< share of the error below which a gain is rounding
constexpr std::ptrdiff_t reach_of_one = 16;  ///< intervals to each side
constexpr std::ptrdiff_t reach_of_two = 3;   ///< the same if two neighbouring knots move at once
constexpr std::size_t max_places_for_pairs = 2000;
constexpr int steps = 8;
constexpr double least_share = 0.05;  ///< of a step
constexpr int sweeps = 8;

using Held = std::array<bool, max_segments + 1>;  ///< which knots stay where they are

/// Which knots lie exactly at points: in a kink of the error.
Held at_points(const Points& points, const std::vector<double>& knots) {
  Held held{};
  for (std::size_t i = 0; i < knots.size(); ++i) {
    held[i] = std::binary_search(points.places.begin(), points.places.end(), knots[i]);
  }
  return held;
}

void hold(Sensitivity& sensitivity, const Held& held) {
  for (Eigen::Index i = 0; i < sensitivity.gradient.size(); ++i) {
    if (!held[static_cast<std::size_t>(i) + 1]) continue;
    sensitivity.normal.row(i).setZero();
    sensitivity.normal.col(i).setZero();
    sensitivity.normal(i, i) = 1.0;
    sensitivity.gradient[i] = 0.0;
  }
}

/// The best of a few Gauss-Newton steps, halved until they gain, below a limit; the limit itself if there is
/// none.
Polished stepped(const Points& points, const std::vector<double>& start, const Held& held,
                 std::size_t fewest_points, double limit) {
  Polished best{.knots = start, .error = limit};
  if (!allowed(points, start, fewest_points)) return best;
  auto knots = start;
  Sensitivity here;
  double error = best_forces(points, knots, &here).error;
  for (int step = 0; step < steps; ++step) {
    hold(here, held);
    here.normal.diagonal() *= 1.0 + 1e-12;
    here.normal.diagonal().array() += 1e-300;
    const Sensitivity::Vector move = here.normal.ldlt().solve(here.gradient);
    const double promised = here.gradient.dot(move);
    if (!move.allFinite() || !(promised > hop_gain * error)) break;
    // Where the steps no longer lead below the limit, they would only lead elsewhere.
    if (step > 1 && error - 2.0 * promised > limit) break;
    double share = 1.0;
    double next_error = error;
    Sensitivity there;
    auto next = knots;
    for (; share > least_share; share *= 0.5) {
      for (Eigen::Index i = 0; i < move.size(); ++i) {
        const auto knot = static_cast<std::size_t>(i) + 1;
        next[knot] = knots[knot] - share * move[i];
      }
      if (!allowed(points, next, fewest_points)) continue;
      next_error = best_forces(points, next, &there).error;
      if (next_error < error) break;
    }
    if (!(next_error < error)) break;
    knots = next;
    here = there;
    error = next_error;
  }
  if (error < limit) {
    best.knots = knots;
    best.error = error;
  }
  return best;
}

/// Where a knot may sit: in the middle of an interval between points, from where it may move, or at a point.
struct KnotPlace {
  double position;
  bool held;
};

class Relocation {
 public:
  Relocation(const Points& points, const Polished& start, std::size_t fewest_points)
      : points_(points), fewest_points_(fewest_points), best_(start) {}

  Polished run() {
    const bool pairs = points_.places.size() <= max_places_for_pairs;
    bool moved = true;
    for (int sweep = 0; sweep < sweeps && moved; ++sweep) {
      const double before = best_.error;
      for (std::size_t knot = 1; knot + 1 < best_.knots.size(); ++knot) relocate_one(knot);
      for (std::size_t knot = 1; pairs && knot + 2 < best_.knots.size(); ++knot) relocate_two(knot);
      moved = best_.error < before - hop_gain * before;
      ++best_.iterations;
    }
    return best_;
  }

 private:
  [[nodiscard]] std::vector<KnotPlace> places_around(double knot, std::ptrdiff_t reach) const {
    const auto& places = points_.places;
    const auto at = std::upper_bound(places.begin(), places.end(), knot) - places.begin();
    std::vector<KnotPlace> all;
    for (auto i = std::max<std::ptrdiff_t>(at - reach, 1);
         i <= std::min<std::ptrdiff_t>(at + reach, std::ssize(places) - 1); ++i) {
      const auto place = places.begin() + i;
      all.push_back({0.5 * (*(place - 1) + *place), false});
      if (*place < 1.0) all.push_back({*place, true});
    }
    return all;
  }

  void relocate_one(std::size_t knot) {
    const auto from = best_.knots;
    const Held held = at_points(points_, from);
    for (const KnotPlace& place : places_around(from[knot], reach_of_one)) {
      auto knots = from;
      knots[knot] = place.position;
      Held now{};
      now[knot] = place.held;
      take(knots, now);
      now = held;
      now[knot] = place.held;
      take(knots, now);
    }
  }

  void relocate_two(std::size_t knot) {
    const auto from = best_.knots;
    const auto others = places_around(from[knot + 1], reach_of_two);
    for (const KnotPlace& place : places_around(from[knot], reach_of_two)) {
      for (const KnotPlace& other : others) {
        if (!(place.position < other.position)) continue;
        auto knots = from;
        knots[knot] = place.position;
        knots[knot + 1] = other.position;
        Held now{};
        now[knot] = place.held;
        now[knot + 1] = other.held;
        take(knots, now);
      }
    }
  }

  void take(const std::vector<double>& knots, const Held& held) {
    const Polished next = stepped(points_, knots, held, fewest_points_, best_.error);
    if (!(next.error < best_.error)) return;
    best_.knots = next.knots;
    best_.error = next.error;
  }

  const Points& points_;
  std::size_t fewest_points_;
  Polished best_;
};

}  // namespace

Polished relocate(const Points& points, const Polished& start, std::size_t fewest_points) {
  return Relocation(points, start, fewest_points).run();
}

}  // namespace kerf::fitting::segmented

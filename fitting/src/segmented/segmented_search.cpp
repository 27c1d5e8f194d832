#include "segmented/segmented_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "infinite.h"
#include "segmented/segmented_grid.h"
#include "segmented/segmented_knots.h"

namespace kerf::fitting::segmented {
namespace {

constexpr double search_gain = 1e-12;  ///< share of an error below which a gain is rounding
constexpr std::size_t max_places_for_relocation = 50'000;  ///< with more the kinks are too small to matter
constexpr double hopeless = 1.5;    ///< times the best error: not worth more than a first descent
constexpr double promising = 1.02;  ///< times the best error: within reach of it

std::vector<double> even_grid(std::size_t cells) {
  std::vector<double> places;
  for (std::size_t i = 0; i <= cells; ++i) {
    places.push_back(static_cast<double>(i) / static_cast<double>(cells));
  }
  return places;
}

/// Places where the points are: all of them and their middles if there are few, or evenly many points apart,
/// and then half as many as there are cells.
std::vector<double> grid_by_points(const Points& points, std::size_t cells) {
  std::vector<double> places;
  const std::size_t count = points.places.size();
  if (2 * count <= cells) {
    for (std::size_t i = 0; i + 1 < count; ++i) {
      places.push_back(points.places[i]);
      places.push_back(0.5 * (points.places[i] + points.places[i + 1]));
    }
  } else {
    const std::size_t most = std::min(cells / 2, count - 1);
    for (std::size_t i = 0; i < most; ++i) places.push_back(points.places[i * (count - 1) / most]);
  }
  places.push_back(1.0);
  return places;
}

/// Improves curves from starts: on the grid by moving all knots a few places at a time, off it by the polish.
class Climb {
 public:
  Climb(const Points& points, const SegmentedOptions& options, std::vector<double> places, bool on_grid)
      : points_(points),
        fewest_(options.fewest_points),
        cell_(2.0 / static_cast<double>(options.cells)),
        on_grid_(on_grid),
        places_(std::move(places)) {}

  /// Improves a start and keeps it if it is better; returns whether it is.
  bool offer(Polished& best, const std::vector<double>& knots) const {
    if (knots.empty()) return false;
    Polished moved = on_grid_ ? slide(knots) : polish(knots, best);
    const bool better = best.knots.empty() || moved.error < best.error - search_gain * best.error;
    const int iterations = best.iterations + moved.iterations;
    if (better) best = std::move(moved);
    best.iterations = iterations;
    return better;
  }

  /// The knots with one more, where it helps most; none if there is no room.
  [[nodiscard]] std::vector<double> with_one_more(const std::vector<double>& knots) const {
    std::vector<double> best;
    double least = infinite;
    for (const double place : places_) {
      auto more = knots;
      more.insert(std::lower_bound(more.begin(), more.end(), place), place);
      if (!allowed(points_, more, fewest_)) continue;
      const double error = best_forces(points_, more).error;
      if (error < least) {
        least = error;
        best = std::move(more);
      }
    }
    return best;
  }

  /// The knots without the one that matters least.
  [[nodiscard]] std::vector<double> with_one_less(const std::vector<double>& knots) const {
    std::vector<double> best;
    double least = infinite;
    for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
      auto fewer = knots;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      const double error = best_forces(points_, fewer).error;
      if (error < least) {
        least = error;
        best = std::move(fewer);
      }
    }
    return best;
  }

 private:
  [[nodiscard]] Polished polish(const std::vector<double>& knots, const Polished& best) const {
    Polished moved = descend(points_, knots, fewest_);
    if (moved.error > hopeless * best.error) return moved;
    return settle(points_, moved, fewest_, cell_, promising * best.error);
  }

  [[nodiscard]] Polished slide(const std::vector<double>& knots) const {
    Polished best{.knots = knots, .error = best_forces(points_, knots).error};
    Grid grid{.places = places_, .max_segments = knots.size() - 1, .fewest_points = fewest_, .beam = 8};
    constexpr std::size_t reach = 4;
    for (bool moved = knots.size() > 2; moved;) {
      grid.windows.clear();
      for (std::size_t i = 1; i + 1 < best.knots.size(); ++i) {
        const auto at = static_cast<std::size_t>(
            std::lower_bound(places_.begin(), places_.end(), best.knots[i]) - places_.begin());
        grid.windows.emplace_back(std::max(at, reach + 1) - reach, std::min(at + reach, places_.size() - 2));
      }
      grid.reachable.assign(knots.size(), best.error);
      const GridPath path = search_grid(points_, grid).front();
      moved = !path.knots.empty() && path.error < best.error * (1.0 - search_gain);
      if (moved) best = {.knots = path.knots, .error = path.error};
    }
    return best;
  }

  const Points& points_;
  std::size_t fewest_;
  double cell_;
  bool on_grid_;
  std::vector<double> places_;
};

/// Exchanges starts between neighbouring numbers of segments until none gains.
void exchange(const Climb& climb, std::vector<Polished>& all, int passes) {
  std::vector<bool> fresh(all.size(), true);  // changed since it was last offered to its neighbours
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<bool> changed(all.size(), false);
    for (std::size_t i = all.size(); i-- > 2;) {
      if (!fresh[i] && !changed[i]) continue;
      if (climb.offer(all[i - 1], climb.with_one_less(all[i].knots))) changed[i - 1] = true;
    }
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (!fresh[i - 1] && !changed[i - 1]) continue;
      if (climb.offer(all[i], climb.with_one_more(all[i - 1].knots))) changed[i] = true;
    }
    fresh = std::move(changed);
  }
}

/// Curves on a grid for each number of segments: good ones, made one knot after the other and exchanged, and
/// the best, which those bound.
struct OnGrid {
  std::vector<Polished> good;
  std::vector<GridPath> best;
};

OnGrid search_on(const Points& points, const SegmentedOptions& options, const std::vector<double>& places) {
  const Climb climb(points, options, places, true);
  OnGrid curves;
  std::vector<double> knots{0.0, 1.0};
  for (std::size_t s = 1; s <= options.max_segments && !knots.empty(); ++s) {
    climb.offer(curves.good.emplace_back(), knots);
    knots = climb.with_one_more(curves.good.back().knots);
  }
  exchange(climb, curves.good, 2);
  Grid grid{.places = places,
            .max_segments = options.max_segments,
            .fewest_points = options.fewest_points,
            .reachable = std::vector<double>(options.max_segments + 1, infinite)};
  for (std::size_t i = 0; i < curves.good.size(); ++i) grid.reachable[i + 1] = curves.good[i].error;
  curves.best = search_grid(points, grid);
  return curves;
}

/// Leaves the grid, from its best and its good curves and from those on a grid that follows the points.
void polish(const Points& points, const SegmentedOptions& options, const OnGrid& even,
            std::vector<Polished>& best) {
  const auto places = grid_by_points(points, options.cells);
  const OnGrid uneven = search_on(points, options, places);
  const Climb climb(points, options, places, false);
  for (std::size_t i = 0; i < best.size(); ++i) {
    climb.offer(best[i], even.best[i].knots);
    climb.offer(best[i], uneven.best[i].knots);
    for (const OnGrid* grid : {&even, &uneven}) {
      if (i < grid->good.size() && grid->good[i].knots != grid->best[i].knots) {
        climb.offer(best[i], grid->good[i].knots);
      }
    }
  }
  exchange(climb, best, 3);
  if (points.places.size() > max_places_for_relocation) return;
  for (Polished& each : best) each = relocate(points, each, options.fewest_points);
}

/// Leaves the grid from its best curves alone, and each from that of one segment less.
void polish_briefly(const Points& points, const SegmentedOptions& options, std::vector<Polished>& best) {
  const Climb climb(points, options, even_grid(options.cells), false);
  for (std::size_t i = 0; i < best.size(); ++i) {
    best[i] = descend(points, best[i].knots, options.fewest_points);
    if (i > 0 && best[i].error > best[i - 1].error)
      climb.offer(best[i], climb.with_one_more(best[i - 1].knots));
  }
}

}  // namespace

std::vector<Found> search(const Points& points, const SegmentedOptions& options) {
  const OnGrid even = search_on(points, options, even_grid(options.cells));
  std::vector<Found> all;
  std::vector<Polished> best;
  for (const GridPath& path : even.best) {
    if (path.knots.empty()) break;
    const double error = best_forces(points, path.knots).error;
    best.push_back({.knots = path.knots, .error = error});
    all.push_back({.best = {}, .error_on_grid = error, .optimal_on_grid = path.optimal});
  }
  if (options.polish == Polish::thorough) polish(points, options, even, best);
  if (options.polish == Polish::brief) polish_briefly(points, options, best);
  for (std::size_t i = 0; i < all.size(); ++i) {
    // The points carry one segment more only if it does not cost.
    if (i > 0 && best[i].error > best[i - 1].error + search_gain * points.weight) {
      all.resize(i);
      break;
    }
    all[i].best = std::move(best[i]);
  }
  return all;
}

}  // namespace kerf::fitting::segmented

#include "chart/pareto_front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <kerf/fitting/fit.h>

namespace kerf::bench {
namespace {

using Places = std::vector<std::size_t>;

/// The most that still counts as equal to a cost.
double equal_to(double cost_ns, const ParetoTolerance& tolerance) {
  return cost_ns * (1.0 + tolerance.cost_share) + tolerance.cost_ns;
}

/// Of a class with costs that count as equal, the one for the front: the least error, and of all that count
/// as equal to that one in both, in the class or just beyond its edge, the simplest.
std::size_t best_of(std::span<const ParetoEntry> entries, const Places& better, double max_ns,
                    const AsGood& as_good, const ParetoTolerance& tolerance) {
  const auto in_class = [&](std::size_t place) { return entries[place].cost_ns <= max_ns; };
  std::size_t least = *std::find_if(better.begin(), better.end(), in_class);
  for (const std::size_t place : better) {
    if (in_class(place) && entries[place].error < entries[least].error) least = place;
  }
  const double equal_ns = equal_to(entries[least].cost_ns, tolerance);
  std::size_t best = least;
  const auto rank = [&](std::size_t place) {
    return std::tuple(entries[place].parameters, entries[place].name, place);
  };
  for (const std::size_t place : better) {
    if (entries[place].cost_ns > equal_ns || !as_good(place, least)) continue;
    if (rank(place) < rank(best)) best = place;
  }
  return best;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const ParetoEntry> entries, const AsGood& as_good,
                                      const ParetoTolerance& tolerance) {
  Places front;
  for (;;) {
    Places better;
    double cheapest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const ParetoEntry& entry = entries[i];
      if (!entry.competes || !std::isfinite(entry.cost_ns) || !std::isfinite(entry.error)) continue;
      if (!front.empty() && (entry.error >= entries[front.back()].error || as_good(front.back(), i)))
        continue;
      better.push_back(i);
      cheapest = std::min(cheapest, entry.cost_ns);
    }
    if (better.empty()) return front;
    front.push_back(best_of(entries, better, equal_to(cheapest, tolerance), as_good, tolerance));
  }
}

std::vector<std::size_t> pareto_front(std::span<const ParetoEntry> entries) {
  return pareto_front(entries, [&](std::size_t one, std::size_t other) {
    return fitting::left_out(entries[one].error, entries[other].error) <= 1.0;
  });
}

}  // namespace kerf::bench

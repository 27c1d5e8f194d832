#include "chart/front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace kerf::bench {
namespace {

using Places = std::vector<std::size_t>;

double error_of(const FrontEntry& entry, const FrontTolerance& tolerance) {
  return std::max(entry.error, tolerance.error_floor);
}

/// Of a class with costs that count as equal, the one for the front.
std::size_t best_of(std::span<const FrontEntry> entries, const Places& places,
                    const FrontTolerance& tolerance) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t place : places) least = std::min(least, error_of(entries[place], tolerance));
  const double within = least * (1.0 + tolerance.error_share);
  std::size_t best = places.front();
  const auto rank = [&](std::size_t place) {
    return std::tuple(error_of(entries[place], tolerance) > within, entries[place].parameters,
                      entries[place].name);
  };
  for (const std::size_t place : places) {
    if (rank(place) < rank(best)) best = place;
  }
  return best;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const FrontEntry> entries, const FrontTolerance& tolerance) {
  Places front;
  double reached = std::numeric_limits<double>::infinity();
  for (;;) {
    Places better;
    double cheapest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const FrontEntry& entry = entries[i];
      if (!entry.competes || !std::isfinite(entry.cost_ns) || !std::isfinite(entry.error)) continue;
      if (!(error_of(entry, tolerance) * (1.0 + tolerance.error_share) < reached)) continue;
      better.push_back(i);
      cheapest = std::min(cheapest, entry.cost_ns);
    }
    if (better.empty()) return front;
    const double most = cheapest * (1.0 + tolerance.cost_share) + tolerance.cost_ns;
    std::erase_if(better, [&](std::size_t i) { return entries[i].cost_ns > most; });
    front.push_back(best_of(entries, better, tolerance));
    reached = error_of(entries[front.back()], tolerance);
  }
}

}  // namespace kerf::bench

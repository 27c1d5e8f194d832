#include <algorithm>
#include <cmath>

#include <kerf/identification/shots.h>

namespace kerf::identification {
namespace {

constexpr std::size_t slope_ticks = 8;
constexpr std::size_t shortest_part = 36;  // of which a shot may begin a third later
constexpr std::size_t shortest_shot = 24;

/// The tick of [from, to) where the axis moves fastest.
std::size_t fastest(const AxisData& data, std::size_t from, std::size_t to) {
  std::size_t best = from;
  double best_step = -1.0;
  for (std::size_t n = from; n < to && n + slope_ticks < data.position_m.size(); ++n) {
    const double step = std::abs(data.position_m[n + slope_ticks] - data.position_m[n]);
    if (step > best_step) {
      best_step = step;
      best = n;
    }
  }
  return best;
}

}  // namespace

std::vector<Shot> make_shots(const AxisData& data, std::span<const Stretch> stretches,
                             std::size_t most_parts) {
  std::vector<Shot> shots;
  std::size_t first_cluster = 0;
  for (const Stretch& stretch : stretches) {
    const std::size_t parts = std::clamp<std::size_t>(stretch.period / shortest_part, 1, most_parts);
    const std::size_t length = stretch.period / parts;
    std::vector<std::size_t> begins;
    for (std::size_t cut = 0; cut < stretch.periods * parts; ++cut) {
      const std::size_t from = stretch.begin + cut / parts * stretch.period + cut % parts * length;
      begins.push_back(fastest(data, from, from + std::max<std::size_t>(1, length / 3)));
    }
    for (std::size_t cut = 0; cut < begins.size(); ++cut) {
      const std::size_t end = cut + 1 < begins.size() ? begins[cut + 1] : stretch.end();
      if (end < begins[cut] + shortest_shot) continue;
      shots.push_back({.begin = begins[cut],
                       .count = end - begins[cut],
                       .cluster = first_cluster + cut % parts,
                       .place = stretch.place});
    }
    first_cluster += parts;
  }
  return shots;
}

}  // namespace kerf::identification

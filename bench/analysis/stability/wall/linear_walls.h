#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "stability/device/sampled_loop.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench {

/// How many walls one packet holds, and as many cost little more than one.
inline constexpr std::size_t walls_together = 16;

/// Farther than that from where it began nothing comes back [m].
inline constexpr double lost_m = 10.0;

/// Mean energy of a motion about its mean, M v^2 + K (x - mean)^2, from sums over so many ticks [J].
[[nodiscard]] inline double energy_about_mean(double mass_kg, double stiffness_n_per_m, double position,
                                              double position_squared, double speed_squared, double ticks) {
  const double mean = position / ticks;
  return mass_kg * speed_squared / ticks +
         stiffness_n_per_m * std::max(0.0, position_squared / ticks - mean * mean);
}

/// Whether two-sided walls on a linear device come to rest, as WallSimulation says it: their energy falls
/// from the second quarter of the time to the last, or is what is left of a billionth of the start. Each wall
/// moves as a SampledLoop of its own does, to the bit, and all do side by side in packets of the processor.
/// @param device is_linear() @param start_m inside the wall, at rest [m]
[[nodiscard]] std::vector<bool> linear_walls_come_to_rest(const SampledDevice& device,
                                                          const DeviceMotion& moves,
                                                          std::span<const Wall> walls, double start_m,
                                                          std::size_t ticks_a_quarter);

}  // namespace kerf::bench

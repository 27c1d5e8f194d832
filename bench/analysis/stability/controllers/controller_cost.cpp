#include "stability/controllers/controller_cost.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "chart/cost/timed_ticks.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr std::size_t timed_steps = 2000;
constexpr std::size_t cost_rounds = 20;
constexpr double quiet_rounds = 0.1;

/// The median of a round, in units of the stamp.
template <typename Step>
double median_of(std::uint64_t step_of_stamps, const std::vector<AxisReading>& motion, Step step) {
  std::vector<double> durations(motion.size());
  volatile double kept = 0.0;  // so that no step is left out
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const AxisReading reading = motion[i];
    const std::uint64_t begin = stamp();
    const double force_n = step(reading);
    durations[i] = static_cast<double>(stamp() - begin);
    kept = force_n;
  }
  (void)kept;
  return fine_median(durations, step_of_stamps);
}

}  // namespace

std::vector<double> controller_costs(std::span<const ControllerDesign> designs, const Wall& wall) {
  constexpr double amplitude_m = 1e-3;
  constexpr double turn_rad_s = 2.0 * std::numbers::pi * 5.0;
  std::vector<AxisReading> motion(timed_steps);
  std::vector<ControlledWall> walls;
  for (const ControllerDesign& design : designs) walls.emplace_back(design);
  if (walls.empty()) return {};
  for (std::size_t i = 0; i < timed_steps; ++i) {
    const double angle = turn_rad_s * designs.front().device.period_s * static_cast<double>(i);
    motion[i] = {.position_m = amplitude_m * std::sin(angle),
                 .speed_m_s = amplitude_m * turn_rad_s * std::cos(angle)};
  }
  const StampRate rate;
  const std::uint64_t step_of_stamps = smallest_step();
  std::vector<std::vector<double>> medians(walls.size());
  for (std::size_t round = 0; round < cost_rounds; ++round) {
    const double empty =
        median_of(step_of_stamps, motion, [](const AxisReading& at) { return at.position_m; });
    for (std::size_t i = 0; i < walls.size(); ++i) {
      ControlledWall& one = walls[(round + i) % walls.size()];
      one.begin(wall);
      const double median =
          median_of(step_of_stamps, motion, [&](const AxisReading& at) { return one.step(at); });
      medians[(round + i) % walls.size()].push_back(std::max(0.0, median - empty));
    }
  }
  std::vector<double> costs;
  for (const std::vector<double>& of_one : medians)
    costs.push_back(rate.unit_ns() * quantile(of_one, quiet_rounds));
  return costs;
}

}  // namespace kerf::bench

#include "stability/wall_simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/bisection.h"
#include "stability/sampled_loop.h"

namespace kerf::bench {
namespace {

constexpr double lost_m = 10.0;            // farther than that nothing comes back
constexpr double limit_cycle_decay = 0.9;  // of the energy, from the second to the last quarter
constexpr double at_rest_share = 1e-9;     // of the first displacement
constexpr double periods_of_soft_walls = 20.0;

struct WallForce {
  Wall wall;
  bool one_sided;
  double operator()(const AxisReading& reading) const noexcept {
    if (one_sided && reading.place_m <= 0.0) return 0.0;
    const double force =
        -wall.stiffness_n_per_m * reading.place_m - wall.damping_n_s_per_m * reading.speed_m_s;
    return one_sided ? std::min(force, 0.0) : force;
  }
};

/// Sums over a stretch of time, for the energy about the mean.
struct Stretch {
  double place = 0.0, place_squared = 0.0, speed_squared = 0.0;
  std::size_t ticks = 0;

  void add(const AxisMotion& motion) noexcept {
    place += motion.place_m;
    place_squared += motion.place_m * motion.place_m;
    speed_squared += motion.speed_m_s * motion.speed_m_s;
    ++ticks;
  }
  [[nodiscard]] double variance() const noexcept {
    const auto count = static_cast<double>(ticks);
    return std::max(0.0, place_squared / count - place * place / (count * count));
  }
  [[nodiscard]] double energy(double mass, double stiffness) const noexcept {
    return mass * speed_squared / static_cast<double>(ticks) + stiffness * variance();
  }
};

}  // namespace

bool comes_to_rest(const SampledDevice& device, const Wall& wall, const WallTrial& trial) {
  const bool one_sided = trial.push_n > 0.0;
  const double start_m = trial.start_m + (one_sided ? trial.push_n / wall.stiffness_n_per_m : 0.0);
  SampledLoop loop(device, WallForce{wall, one_sided}, {.place_m = start_m});
  const auto quarter =
      std::max<std::size_t>(static_cast<std::size_t>(0.25 * trial.seconds / device.period_s), 4);
  Stretch second;
  Stretch last;
  for (std::size_t tick = 0; tick < 4 * quarter; ++tick) {
    loop.step(trial.push_n);
    if (tick / quarter == 1) second.add(loop.motion());
    if (tick / quarter == 3) last.add(loop.motion());
    if (!(std::abs(loop.motion().place_m) < lost_m + start_m)) return false;
  }
  const double floor_m = std::max(device.encoder_step_m, at_rest_share * trial.start_m);
  const double stiffness = wall.stiffness_n_per_m + device.hand.stiffness_n_per_m;
  const double energy = last.energy(device.moving_mass_kg(), stiffness);
  if (energy <= 2.0 * stiffness * floor_m * floor_m) return true;
  return energy < (device.is_linear() && !one_sided ? 1.0 : limit_cycle_decay) *
                      second.energy(device.moving_mass_kg(), stiffness);
}

double simulated_boundary(const SampledDevice& device, double wall_damping, double softest, double stiffest,
                          const WallTrial& trial, double share) {
  return first_change({.lower = softest, .upper = stiffest, .share = share}, [&](double stiffness) {
    const double rate = std::sqrt((stiffness + device.hand.stiffness_n_per_m) / device.moving_mass_kg());
    WallTrial longer = trial;
    longer.seconds = std::max(trial.seconds, periods_of_soft_walls * 2.0 * std::numbers::pi / rate);
    return comes_to_rest(device, {.stiffness_n_per_m = stiffness, .damping_n_s_per_m = wall_damping}, longer);
  });
}

}  // namespace kerf::bench

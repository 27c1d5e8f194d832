#include "stability/wall/wall_simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/bisection.h"
#include "stability/wall/linear_walls.h"
#include "stability/wall/wall_force.h"

namespace kerf::bench {
namespace {

constexpr double limit_cycle_decay = 0.5;  // of the energy, from the second to the last quarter
constexpr double periods_of_soft_walls = 20.0;

/// Sums over a stretch of time, for the energy about the mean.
struct Stretch {
  double position = 0.0, position_squared = 0.0, speed_squared = 0.0, force = 0.0, force_squared = 0.0;
  std::size_t ticks = 0;

  void add(const AxisMotion& motion, double force_n) noexcept {
    force += force_n;
    force_squared += force_n * force_n;
    position += motion.position_m;
    position_squared += motion.position_m * motion.position_m;
    speed_squared += motion.speed_m_s * motion.speed_m_s;
    ++ticks;
  }
  [[nodiscard]] double energy(double mass, double stiffness) const noexcept {
    return energy_about_mean(mass, stiffness, position, position_squared, speed_squared,
                             static_cast<double>(ticks));
  }
  [[nodiscard]] double ripple_n() const noexcept { return std::sqrt(variance(force, force_squared)); }

 private:
  [[nodiscard]] double variance(double sum, double squares) const noexcept {
    const auto count = static_cast<double>(ticks);
    return std::max(0.0, squares / count - sum * sum / (count * count));
  }
};

/// A wall's trial while it runs, of one that has limit cycles.
class Trial {
 public:
  Trial(const SampledDevice& device, const std::shared_ptr<const DeviceMotion>& moves, const Wall& wall,
        const WallTrial& trial)
      : trial_(trial),
        mass_(device.moving_mass_kg()),
        stiffness_(wall.stiffness_n_per_m + device.hand.stiffness_n_per_m),
        start_m_(trial.start_m + (trial.push_n > 0.0 ? trial.push_n / wall.stiffness_n_per_m : 0.0)),
        loop_(device, moves, WallForce{wall, trial.push_n > 0.0}, {.position_m = start_m_}) {}

  /// A tick; of no effect once the device is lost.
  void step() noexcept {
    if (lost_) return;
    loop_.step(trial_.push_n);
    quarter_.add(loop_.motion(), loop_.held_n());
    lost_ = !(std::abs(loop_.motion().position_m) < lost_m + start_m_);
  }
  void end_quarter() {
    energy_.push_back(quarter_.energy(mass_, stiffness_));
    is_felt_ = quarter_.ripple_n() > trial_.felt_n;
    quarter_ = {};
  }
  [[nodiscard]] bool is_quiet() const noexcept { return !lost_ && !is_felt_; }
  /// The energy has fallen from quarter to quarter, but for the first, which has what the start left of all
  /// modes, and to a half from the second to the fourth.
  [[nodiscard]] bool decays() const noexcept {
    bool falls = !lost_;
    for (std::size_t i = 2; i < energy_.size(); ++i) falls = falls && energy_[i] < energy_[i - 1];
    return falls && energy_[3] < limit_cycle_decay * energy_[1];
  }

 private:
  WallTrial trial_;
  double mass_;
  double stiffness_;
  double start_m_;
  SampledLoop<WallForce> loop_;
  Stretch quarter_;
  std::vector<double> energy_;  ///< of each quarter
  bool is_felt_ = true;
  bool lost_ = false;
};

}  // namespace

WallSimulation::WallSimulation(const SampledDevice& device)
    : device_(device), moves_(std::make_shared<const DeviceMotion>(device)) {}

bool WallSimulation::comes_to_rest(const Wall& wall, const WallTrial& trial) const {
  return come_to_rest(std::span(&wall, 1), trial).front();
}

std::vector<bool> WallSimulation::come_to_rest(std::span<const Wall> walls, const WallTrial& trial) const {
  constexpr std::size_t together = 8;  // more no longer fit beside each other
  const auto quarter =
      std::max<std::size_t>(static_cast<std::size_t>(0.25 * trial.seconds / device_.period_s), 4);
  if (is_linear(trial)) return linear_walls_come_to_rest(device_, *moves_, walls, trial.start_m, quarter);
  std::vector<bool> rest;
  for (std::size_t begin = 0; begin < walls.size(); begin += together) {
    std::vector<Trial> trials;
    for (const Wall& wall : walls.subspan(begin, std::min(together, walls.size() - begin))) {
      trials.emplace_back(device_, moves_, wall, trial);
    }
    const auto run_a_quarter = [&](std::span<Trial> some) {
      for (std::size_t tick = 0; tick < quarter; ++tick) {
        for (Trial& one : some) one.step();
      }
      for (Trial& one : some) one.end_quarter();
    };
    for (int part = 0; part < 4; ++part) run_a_quarter(trials);
    for (Trial& one : trials) {
      for (int part = 0; part < 4 && !one.is_quiet() && one.decays(); ++part)
        run_a_quarter(std::span(&one, 1));
      rest.push_back(one.is_quiet() || one.decays());
    }
  }
  return rest;
}

double WallSimulation::boundary(double wall_damping, double softest, double stiffest, const WallTrial& trial,
                                double share) const {
  const Search search{.lower = softest, .upper = stiffest, .share = share};
  /// Of several stiffnesses, the first the softest.
  const auto hold = [&](std::span<const double> stiffnesses) {
    const double stiffness = stiffnesses.front() + device_.hand.stiffness_n_per_m;
    WallTrial longer = trial;
    longer.seconds = std::max(trial.seconds, periods_of_soft_walls * 2.0 * std::numbers::pi *
                                                 std::sqrt(device_.moving_mass_kg() / stiffness));
    std::vector<Wall> walls;
    for (const double one : stiffnesses) walls.push_back({one, wall_damping});
    return come_to_rest(walls, longer);
  };
  if (is_linear(trial)) return first_change_of_many(search, walls_together, hold);
  return first_change(search,
                      [&](double stiffness) -> bool { return hold(std::span(&stiffness, 1)).front(); });
}

}  // namespace kerf::bench

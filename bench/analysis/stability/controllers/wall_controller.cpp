#include "stability/controllers/wall_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "stability/device/passivity_controlled.h"

namespace kerf::bench {
namespace {

constexpr double slow_rad_s = 2.0 * std::numbers::pi * 5.0;  // slower is what a hand does

SampledDevice without_hand(const ControllerDesign& design) {
  check(design.device);
  SampledDevice alone = design.device;
  alone.hand = {};
  alone.coulomb_n = 0.0;
  return alone;
}

}  // namespace

std::string_view name_of(WallController controller) noexcept {
  switch (controller) {
    case WallController::none:
      break;
    case WallController::damping:
      return "damping";
    case WallController::coupling:
      return "virtual coupling";
    case WallController::passivity:
      return "passivity";
    case WallController::exact:
      return "exact";
  }
  return "none";
}

ControlledWall::ControlledWall(const ControllerDesign& design)
    : controller_(design.controller),
      period_s_(design.device.period_s),
      gain_(design.device.velocity_gain()),
      slow_gain_(-std::expm1(-slow_rad_s * design.device.period_s)),
      most_damping_(design.controller == WallController::damping ? design.most_damping_n_s_per_m : 0.0),
      coupling_stiffness_(design.coupling_stiffness_n_per_m),
      coupling_damping_(design.coupling_damping_n_s_per_m),
      delay_(design.device),
      brake_(passivity_controller_of(design.device)) {
  const SampledDevice alone = without_hand(design);
  const DeviceMotion moves(alone);
  before_ = moves.before.transition();
  after_ = moves.after.transition();
  whole_ = FreeMotion(alone, period_s_).transition();
}

void ControlledWall::begin(const Wall& wall) noexcept {
  wall_ = wall;
  damping_ = std::max(wall.damping_n_s_per_m, most_damping_);
  started_ = false;
  memory_ = {};
  brake_.restart();
}

double ControlledWall::step_from(Memory& memory, const AxisReading& reading) noexcept {
  started_ = true;
  std::swap(memory_, memory);
  const double force_n = step(reading);
  std::swap(memory_, memory);
  return force_n;
}

double ControlledWall::coupled(double position_m) noexcept {
  const double wall_damping = wall_.damping_n_s_per_m / period_s_;
  const double stiffness = coupling_stiffness_;
  if (!std::exchange(started_, true)) {
    memory_.proxy_m = stiffness * position_m / (stiffness + wall_.stiffness_n_per_m);
    memory_.last_m = position_m - memory_.proxy_m;
  }
  const double fresh = coupling_damping_ * gain_ / period_s_;
  const double direct = stiffness + fresh;
  const double carried = coupling_damping_ * (1.0 - gain_) * memory_.rate_m_s - fresh * memory_.last_m;
  const double resists = wall_.stiffness_n_per_m + wall_damping + direct;
  if (!(resists > 0.0)) return 0.0;
  const double proxy_m = (direct * position_m + carried + wall_damping * memory_.proxy_m) / resists;
  const double between_m = position_m - proxy_m;
  memory_.rate_m_s += gain_ * ((between_m - memory_.last_m) / period_s_ - memory_.rate_m_s);
  memory_.last_m = between_m;
  memory_.proxy_m = proxy_m;
  return -stiffness * between_m - coupling_damping_ * memory_.rate_m_s;
}

double ControlledWall::passive(const AxisReading& reading) noexcept {
  const double stored_j = 0.5 * wall_.stiffness_n_per_m * reading.position_m * reading.position_m;
  if (!std::exchange(started_, true)) stored_j_ = stored_j;
  brake_.observe({reading.position_m}, period_s_, stored_j - std::exchange(stored_j_, stored_j));
  const drivers::Axes rendered{plain(reading)};
  drivers::Axes force = rendered;
  (void)brake_.brake(force);
  brake_.hold(rendered, rendered, force);
  return force[0];
}

double ControlledWall::exact(double position_m) noexcept {
  if (!std::exchange(started_, true)) memory_.last_m = position_m;
  auto& sent = memory_.sent_n;
  const std::size_t ticks = delay_.ticks;
  const bool is_split = delay_.share > 0.0;
  memory_.balance_n += slow_gain_ * (sent[ticks] - memory_.balance_n);
  const double balance_n = memory_.balance_n;
  // The speed now: what the motion since the reading before must have begun with, and came to.
  AxisMotion forced;
  if (is_split) forced = before_.step(forced, sent[ticks + 1] - balance_n);
  forced = after_.step(forced, sent[ticks] - balance_n);
  const double earlier_m_s = (position_m - memory_.last_m - forced.position_m) / whole_.xv;
  AxisMotion at{.position_m = position_m, .speed_m_s = whole_.vv * earlier_m_s + forced.speed_m_s};
  // On to the moment at which the command of this tick arrives.
  for (std::size_t ahead = ticks; ahead > 0; --ahead) {
    if (is_split) at = before_.step(at, sent[ahead] - balance_n);
    at = after_.step(at, sent[ahead - 1] - balance_n);
  }
  if (is_split) at = before_.step(at, sent[0] - balance_n);
  const double slope = 0.5 * wall_.stiffness_n_per_m + wall_.damping_n_s_per_m / period_s_;
  const double moves_m = whole_.xv * at.speed_m_s - whole_.xf * balance_n;
  const double force_n =
      -(wall_.stiffness_n_per_m * at.position_m + slope * moves_m) / (1.0 + slope * whole_.xf);
  memory_.last_m = position_m;
  std::copy_backward(sent.begin(), sent.begin() + static_cast<std::ptrdiff_t>(ticks) + 1,
                     sent.begin() + static_cast<std::ptrdiff_t>(ticks) + 2);
  sent[0] = force_n;
  return force_n;
}

}  // namespace kerf::bench

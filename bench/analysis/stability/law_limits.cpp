#include "stability/law_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <kerf/drivers/hand.h>

#include "stability/bisection.h"
#include "stability/device/passivity_controlled.h"
#include "stability/strokes.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench {
namespace {

constexpr double search_share = 5e-3;
constexpr double fastest_m_s = 10.0;
constexpr double slowest_hz = 20.0;
constexpr double highest_hz = 1e5;
constexpr double largest_force_n = 1000.0;
constexpr double rounding = 1e-12;  // of the energies that a stroke moves to and fro

/// Mean and spread of a force over a stretch of time.
struct Ripple {
  double sum = 0.0, squares = 0.0;
  std::size_t ticks = 0;
  void add(double force) noexcept {
    sum += force;
    squares += force * force;
    ++ticks;
  }
  [[nodiscard]] double rms() const noexcept {
    const auto count = static_cast<double>(ticks);
    return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
  }
};

/// Force of a law that has come to a depth slowly and stayed.
double held_force(const AxisLaw& law, double depth_m, double period_s) {
  LawForce force(law, period_s);
  constexpr int ticks = 1000;
  double felt = 0.0;
  for (int tick = 0; tick <= 2 * ticks; ++tick) {
    const double part = std::min(1.0, static_cast<double>(tick) / ticks);
    const double speed = tick < ticks ? depth_m / (ticks * period_s) : 0.0;
    felt = -force({.position_m = part * depth_m, .speed_m_s = speed});
  }
  return felt;
}

template <typename Holds>
Limit limit_of(const Search& search, Holds holds) {
  Limit limit{.first = search.lower, .last = search.upper, .at = first_change(search, holds)};
  limit.holds_nowhere = *limit.at <= search.lower;
  if (limit.holds_nowhere || *limit.at >= search.upper) limit.at.reset();
  return limit;
}

/// Of periods, as rates.
Limit inverse(Limit limit) {
  limit.first = 1.0 / limit.first;
  limit.last = 1.0 / limit.last;
  if (limit.at) limit.at = 1.0 / *limit.at;
  return limit;
}

SampledDevice at_rate(SampledDevice device, double rate_hz) {
  device.period_s = 1.0 / rate_hz;
  return device;
}

}  // namespace

std::vector<Stroke> strokes_at(double depth_m, double fastest, double period_s) {
  std::vector<Stroke> strokes;
  for (const double part : {1.0, 0.3, 0.1, 0.01}) {
    const double way_m = part * depth_m;
    const auto least = std::max(1.0, std::ceil(way_m / (fastest * period_s) - 1e-9));
    for (const double slower : {1.0, 2.0, 5.0, 20.0}) {
      if (least * slower > 2000.0) continue;
      strokes.push_back(
          {.from_m = depth_m - way_m, .to_m = depth_m, .ticks = static_cast<std::size_t>(least * slower)});
    }
  }
  return strokes;
}

namespace {

constexpr std::array parts_of_depth{1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01};

/// Calls `gain(stroke, energy)` for the strokes that end at a depth and are given more than rounding, until
/// it returns false.
template <typename Visit>
void visit_gains(const SampledDevice& device, const AxisLaw& law, const ToolRange& range, Visit visit) {
  const double rounding_n = rounding * (1.0 + std::abs(held_force(law, range.depth_m, device.period_s)));
  for (const Stroke& stroke : strokes_at(range.depth_m, range.speed_m_s, device.period_s)) {
    const double energy_j = energy_gained(device, LawForce(law, device.period_s), stroke);
    const bool gains = !(energy_j <= rounding_n * (stroke.to_m - stroke.from_m));
    if (gains && !visit(Gain{stroke, energy_j})) return;
  }
}

}  // namespace

bool is_met(const AxisLaw& law, const ToolRange& range, double period_s) {
  constexpr double fewest = 100.0;
  const double ticks = std::max(fewest, std::ceil(range.depth_m / (range.speed_m_s * period_s)));
  const double speed_m_s = range.depth_m / (ticks * period_s);
  LawForce force(law, period_s);
  for (double tick = 0.0; tick <= ticks; ++tick) {
    if (force({.position_m = range.depth_m * tick / ticks, .speed_m_s = speed_m_s}) != 0.0) return true;
  }
  for (double tick = ticks; tick >= 0.0; --tick) {
    if (force({.position_m = range.depth_m * tick / ticks, .speed_m_s = -speed_m_s}) != 0.0) return true;
  }
  return false;
}

bool is_passive_at(const SampledDevice& device, const AxisLaw& law, const ToolRange& range) {
  bool passive = true;
  visit_gains(device, law, range, [&](const Gain&) { return passive = false; });
  return passive;
}

bool is_passive(const SampledDevice& device, const AxisLaw& law, const ToolRange& range) {
  return std::all_of(parts_of_depth.begin(), parts_of_depth.end(), [&](double part) {
    return is_passive_at(device, law, {part * range.depth_m, range.speed_m_s});
  });
}

std::optional<Gain> worst_stroke(const SampledDevice& device, const AxisLaw& law, const ToolRange& range) {
  std::optional<Gain> worst;
  for (const double part : parts_of_depth) {
    visit_gains(device, law, {part * range.depth_m, range.speed_m_s}, [&](const Gain& gain) {
      if (!worst || gain.energy_j > worst->energy_j) worst = gain;
      return true;
    });
  }
  return worst;
}

double passive_stiffness_up_to(const SampledDevice& device, double speed_m_s, double damping) {
  const double friction = device.viscous_n_s_per_m - worst_of_damping(device) * std::abs(damping);
  const auto at = [&](double speed) {
    return 2.0 * (friction * speed + device.coulomb_n) /
           (device.encoder_step_m + speed * (device.period_s + 2.0 * device.delay_s));
  };
  const double moving = std::max(0.0, at(speed_m_s));
  return device.encoder_step_m == 0.0 ? moving : std::min(moving, at(0.0));
}

Local local_impedance(const AxisLaw& law, double depth_m, double period_s) {
  constexpr int ticks = 1000;
  LawForce come(law, period_s);
  for (int tick = 0; tick <= ticks; ++tick)
    (void)come({.position_m = depth_m * tick / ticks, .speed_m_s = 0.0});
  // Beside one that stays, so that a law that relaxes is not taken for a softer one.
  const auto next = [&](double position_m, double speed_m_s) {
    LawForce from_here = come;
    return -from_here({.position_m = position_m, .speed_m_s = speed_m_s});
  };
  const double little_m = 1e-4 * depth_m;
  constexpr double little_m_s = 1e-3;
  const double staying_n = next(depth_m, 0.0);
  return {.stiffness_n_per_m = (next(depth_m + little_m, 0.0) - staying_n) / little_m,
          .damping_n_s_per_m = (next(depth_m, little_m_s) - staying_n) / little_m_s};
}

bool is_locally_passive(const SampledDevice& device, const AxisLaw& law, const ToolRange& range) {
  const Local local = local_impedance(law, range.depth_m, device.period_s);
  return local.stiffness_n_per_m <= passive_stiffness_up_to(device, range.speed_m_s, local.damping_n_s_per_m);
}

LawLimits limits_of(const SampledDevice& device, const AxisLaw& law, const ToolRange& range,
                    double deepest_m) {
  const Search depths{.lower = 1e-3 * deepest_m, .upper = deepest_m, .share = search_share, .scan = 24};
  const Search speeds{.lower = 1e-4, .upper = fastest_m_s, .share = search_share, .scan = 16};
  const Search periods{
      .lower = 1.0 / highest_hz, .upper = 1.0 / slowest_hz, .share = search_share, .scan = 16};
  LawLimits limits;
  limits.depth_m = limit_of(depths, [&](double depth_m) {
    return is_passive_at(device, law, {depth_m, range.speed_m_s});
  });
  limits.speed_m_s = limit_of(speeds, [&](double speed_m_s) {
    return is_passive(device, law, {range.depth_m, speed_m_s});
  });
  limits.rate_hz = inverse(limit_of(
      periods, [&](double period_s) { return is_passive(at_rate(device, 1.0 / period_s), law, range); }));
  limits.passive_at_all = is_passive(at_rate(device, highest_hz), law, {1e-3 * deepest_m, 1e-4}) ||
                          limits.depth_m.at || limits.speed_m_s.at;
  limits.local = local_impedance(law, limits.depth_m.at.value_or(range.depth_m), device.period_s);
  limits.passive_stiffness_n_per_m =
      passive_stiffness_up_to(device, range.speed_m_s, limits.local.damping_n_s_per_m);
  limits.local_depth_m = limit_of(depths, [&](double depth_m) {
    return is_locally_passive(device, law, {depth_m, range.speed_m_s});
  });
  return limits;
}

namespace {

/// press() of a force, of which `added` tells what a controller has put on it in a step.
template <typename Force, typename Added>
PressVerdict pressed(const SampledDevice& device, Force force, const Press& how, double pulled_m,
                     double felt_n, Added added) {
  const double begin_m = -0.2 * how.depth_m;
  const double way_m = how.depth_m + pulled_m - begin_m;
  SampledLoop loop(device, std::move(force), {.position_m = begin_m});
  const auto approach = static_cast<std::size_t>(how.approach_s / device.period_s);
  const auto quarter =
      std::max<std::size_t>(static_cast<std::size_t>(0.25 * how.hold_s / device.period_s), 4);
  const std::size_t ticks = approach + 4 * quarter;
  Ripple second;
  Ripple last;
  double added_squares = 0.0;
  PressVerdict verdict;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const double part = static_cast<double>(tick) / static_cast<double>(std::max<std::size_t>(approach, 1));
    const drivers::MinimumJerk hand = drivers::MinimumJerk::at(part);
    const double hand_speed = part < 1.0 ? hand.speed * way_m / how.approach_s : 0.0;
    loop.step(device.hand.damping_n_s_per_m * hand_speed, begin_m + way_m * hand.position);
    const double force_n = -loop.held_n();
    verdict.peak_n = std::max(verdict.peak_n, std::abs(force_n));
    if (!(std::abs(force_n) < largest_force_n))
      return {.stable = false, .ripple_n = force_n, .peak_n = force_n};
    const double added_n = added(loop.force());
    added_squares += added_n * added_n;
    if (tick < approach) continue;
    if ((tick - approach) / quarter == 1) second.add(force_n);
    if ((tick - approach) / quarter == 3) last.add(force_n);
  }
  verdict.ripple_n = last.rms();
  verdict.added_n = std::sqrt(added_squares / static_cast<double>(ticks));
  verdict.stable = verdict.ripple_n <= felt_n || verdict.ripple_n < 0.9 * second.rms();
  return verdict;
}

/// As a PassivityControlled force asks for it.
struct StoredByLaw {
  double operator()(const LawForce& force, const AxisReading&) const noexcept { return force.stored_j(); }
};

}  // namespace

PressVerdict press(const SampledDevice& device, const AxisLaw& law, const Press& how, double felt_n) {
  const double pulled_m = held_force(law, how.depth_m, device.period_s) / device.hand.stiffness_n_per_m;
  LawForce force(law, device.period_s);
  if (how.passivity_control) {
    return pressed(device, PassivityControlled(std::move(force), device, StoredByLaw{}), how, pulled_m,
                   felt_n, [](const auto& controlled) { return controlled.added_n(); });
  }
  return pressed(device, std::move(force), how, pulled_m, felt_n, [](const LawForce&) { return 0.0; });
}

}  // namespace kerf::bench

#include <algorithm>
#include <cmath>
#include <limits>

#include <kerf/identification/axis_model.h>

namespace kerf::identification {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int taylor_order = 12;  // with less than half of a time constant: 1e-13

Transition after_another(const Transition& second, const Transition& first) noexcept {
  return {.xx = second.xx * first.xx + second.xv * first.vx,
          .xv = second.xx * first.xv + second.xv * first.vv,
          .xf = second.xx * first.xf + second.xv * first.vf + second.xf,
          .vx = second.vx * first.xx + second.vv * first.vx,
          .vv = second.vx * first.xv + second.vv * first.vv,
          .vf = second.vx * first.xf + second.vv * first.vf + second.vf};
}

/// The force that moves an axis at a place, without friction.
double drive_at(const AxisModel& model, Motion motion, double force_n) noexcept {
  return force_n - model.stiffness_n_per_m * motion.position_m;
}

/// 1 or -1: which way it moves or begins to; 0: friction holds it.
double direction_of(const AxisModel& model, Motion motion, double force_n) noexcept {
  if (motion.speed_m_s != 0.0) return std::copysign(1.0, motion.speed_m_s);
  const double drive = drive_at(model, motion, force_n);
  return std::abs(drive) > model.coulomb_n ? std::copysign(1.0, drive) : 0.0;
}

}  // namespace

Transition transition_over(const AxisModel& model, double time_s) noexcept {
  const double damping = model.viscous_n_s_per_m / model.mass_kg;
  const double stiffness = model.stiffness_n_per_m / model.mass_kg;
  // In units of the time: the norm of what is expanded.
  const double norm = std::max(std::abs(damping), std::sqrt(std::abs(stiffness))) * time_s;
  const int halvings = norm > 0.5 ? std::min(60, std::ilogb(norm) + 2) : 0;
  const double dt = std::ldexp(time_s, -halvings);
  // Columns of exp(A t): from x = 1, from v = 1, from F = 1; each by its series.
  Transition sum;
  double x[3] = {1.0, 0.0, 0.0};
  double v[3] = {0.0, 1.0, 0.0};
  double* const out[2][3] = {{&sum.xx, &sum.xv, &sum.xf}, {&sum.vx, &sum.vv, &sum.vf}};
  for (int order = 1; order <= taylor_order; ++order) {
    const double share = dt / order;
    for (std::size_t of = 0; of < 3; ++of) {
      const double force = of == 2 && order == 1 ? 1.0 / model.mass_kg : 0.0;
      const double next_v = share * (force - stiffness * x[of] - damping * v[of]);
      x[of] = share * v[of];
      v[of] = next_v;
      *out[0][of] += x[of];
      *out[1][of] += v[of];
    }
  }
  for (int i = 0; i < halvings; ++i) sum = after_another(sum, sum);
  return sum;
}

AxisSimulation::AxisSimulation(const AxisModel& model, double period_s) : model_(model), period_s_(period_s) {
  const double ticks = std::max(0.0, model.delay_s / period_s);
  whole_ticks_ = static_cast<std::size_t>(ticks);
  before_s_ = (ticks - static_cast<double>(whole_ticks_)) * period_s;
  after_s_ = period_s - before_s_;
  before_ = transition_over(model, before_s_);
  after_ = transition_over(model, after_s_);
}

Motion AxisSimulation::part(Motion motion, double force_n, double time_s, const Transition& whole,
                            FrictionSums* sums) const noexcept {
  const auto note = [&](double friction_n, double for_s) {
    if (sums == nullptr) return;
    sums->impulse += friction_n * for_s;
    sums->moment += friction_n * for_s * (sums->from_s + 0.5 * (for_s - period_s_));
    sums->from_s += for_s;
  };
  const double f = model_.coulomb_n;
  const double sign = direction_of(model_, motion, force_n);
  if (sign == 0.0) {
    note(-drive_at(model_, motion, force_n), time_s);
    return {motion.position_m, 0.0};
  }
  const Motion end = whole.step(motion, force_n - sign * f);
  if (end.speed_m_s * sign >= 0.0) {
    note(-sign * f, time_s);
    return end;
  }
  // The speed passes through zero: Newton's steps, kept between the ends.
  double from = 0.0;
  double to = time_s;
  double at = time_s * motion.speed_m_s / (motion.speed_m_s - end.speed_m_s);
  Motion rest = motion;
  for (int i = 0; i < 20; ++i) {
    rest = transition_over(model_, at).step(motion, force_n - sign * f);
    (rest.speed_m_s * sign >= 0.0 ? from : to) = at;
    const double acceleration =
        (drive_at(model_, rest, force_n) - sign * f - model_.viscous_n_s_per_m * rest.speed_m_s) /
        model_.mass_kg;
    double next = at - rest.speed_m_s / acceleration;
    if (!(next >= from && next <= to)) next = 0.5 * (from + to);
    const bool is_there = std::abs(next - at) <= 1e-12 * time_s;
    at = next;
    if (is_there) break;
  }
  rest.speed_m_s = 0.0;
  const double left_s = time_s - at;
  note(-sign * f, at);
  const double back = direction_of(model_, rest, force_n);
  if (back == 0.0) {
    note(-drive_at(model_, rest, force_n), left_s);
    return rest;
  }
  note(-back * f, left_s);
  return transition_over(model_, left_s).step(rest, force_n - back * f);
}

Motion AxisSimulation::after(Motion motion, std::span<const double> commanded_n, std::size_t n,
                             TickFriction* friction) const noexcept {
  const double most = model_.saturation_n > 0.0 ? model_.saturation_n : infinity;
  const auto command = [&](std::size_t back) {
    return n >= back ? std::clamp(commanded_n[n - back], -most, most) : 0.0;
  };
  FrictionSums sums;
  FrictionSums* const told = friction != nullptr ? &sums : nullptr;
  if (before_s_ > 0.0) {
    motion = part(motion, command(whole_ticks_ + 1) + model_.offset_n, before_s_, before_, told);
  }
  motion = part(motion, command(whole_ticks_) + model_.offset_n, after_s_, after_, told);
  if (friction != nullptr) {
    *friction = {.mean_n = sums.impulse / period_s_, .moment_n_s = sums.moment / period_s_};
  }
  return motion;
}

void simulate(const AxisModel& model, double period_s, Motion at_begin, std::span<const double> commanded_n,
              std::size_t begin, std::span<double> position_m, std::span<TickFriction> friction) {
  const AxisSimulation simulation(model, period_s);
  Motion motion = at_begin;
  for (std::size_t i = 0; i < position_m.size(); ++i) {
    position_m[i] = motion.position_m;
    motion = simulation.after(motion, commanded_n, begin + i, friction.empty() ? nullptr : &friction[i]);
  }
}

}  // namespace kerf::identification

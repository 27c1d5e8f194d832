#include "kerf/mechanisms/held_mass.h"

#include "kerf/mechanisms/exponential.h"

namespace kerf::mechanisms {
namespace {

/// From the beginning of a time within which the speed passes through zero to its end. `level(i)` is the
/// transition over 2^-i of the time.
template <typename Level>
AxisMotion past_rest(const HeldMass& mass, AxisMotion motion, double force_n, double sign,
                     Level level) noexcept {
  constexpr std::size_t halvings = HeldMassMotion::halvings;
  std::size_t passed = 0;  // units of 2^-halvings
  for (std::size_t i = 1; i <= halvings; ++i) {
    const AxisMotion next = level(i).step(motion, force_n - sign * mass.friction_n(sign));
    if (next.speed_m_s * sign < 0.0) continue;
    motion = next;
    passed += std::size_t{1} << (halvings - i);
  }
  motion.speed_m_s = 0.0;
  const double back = mass.direction(motion, force_n);
  if (back == 0.0) return motion;
  const std::size_t left = (std::size_t{1} << halvings) - passed;
  for (std::size_t i = 0; i <= halvings; ++i) {
    if ((left >> (halvings - i) & 1U) != 0U)
      motion = level(i).step(motion, force_n - back * mass.friction_n(back));
  }
  return motion;
}

double part_of(double time_s, std::size_t level) noexcept {
  return std::ldexp(time_s, -static_cast<int>(level));
}

}  // namespace

HeldMass::Transition HeldMass::over(double time_s) const noexcept {
  const SquareMatrix<3> rates{{{0.0, 1.0, 0.0},
                               {-stiffness_n_per_m / mass_kg, -damping_n_s_per_m / mass_kg, 1.0 / mass_kg},
                               {0.0, 0.0, 0.0}}};
  const SquareMatrix<3> e = exponential<3>(rates, time_s);
  return {.xx = e[0][0], .xv = e[0][1], .xf = e[0][2], .vx = e[1][0], .vv = e[1][1], .vf = e[1][2]};
}

AxisMotion HeldMass::after(AxisMotion motion, double force_n, double time_s) const noexcept {
  if (is_linear()) return over(time_s).step(motion, force_n);
  const double sign = direction(motion, force_n);
  if (sign == 0.0) return {motion.position_m, 0.0};
  const AxisMotion end = over(time_s).step(motion, force_n - sign * friction_n(sign));
  if (end.speed_m_s * sign >= 0.0) return end;
  return past_rest(*this, motion, force_n, sign,
                   [&](std::size_t level) { return over(part_of(time_s, level)); });
}

HeldMassMotion::HeldMassMotion(const HeldMass& mass, double time_s)
    : mass_(mass), is_linear_(mass.is_linear()) {
  // Without friction nothing looks for its rest.
  const std::size_t levels = is_linear_ ? 1 : levels_.size();
  for (std::size_t level = 0; level < levels; ++level) levels_[level] = mass.over(part_of(time_s, level));
}

AxisMotion HeldMassMotion::through_rest(AxisMotion motion, double force_n, double sign) const noexcept {
  return past_rest(mass_, motion, force_n, sign,
                   [this](std::size_t level) -> const Transition& { return levels_[level]; });
}

}  // namespace kerf::mechanisms

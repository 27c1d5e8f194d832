#include "stability/device/free_motion.h"

namespace kerf::bench {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

/// exp(A t) of the motion with its force as a third, constant state: Taylor's series of a small part of the
/// time, squared up to all of it.
Matrix exponential(Matrix a, double time_s) {
  double norm = 0.0;
  for (const auto& row : a) {
    for (const double entry : row) norm = std::max(norm, std::abs(entry) * time_s);
  }
  const int squarings = norm > 0.0 ? std::max(0, std::ilogb(norm) + 6) : 0;
  const double part_s = std::ldexp(time_s, -squarings);
  Matrix sum{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  Matrix term = sum;
  for (auto& row : a) {
    for (double& entry : row) entry *= part_s;
  }
  for (int order = 1; order <= 12; ++order) {
    term = product(term, a);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) sum[i][j] += (term[i][j] /= order);
    }
  }
  for (int i = 0; i < squarings; ++i) sum = product(sum, sum);
  return sum;
}

}  // namespace

FreeMotion::FreeMotion(const SampledDevice& device, double time_s)
    : coulomb_n_(device.coulomb_n), stiffness_n_per_m_(device.hand.stiffness_n_per_m) {
  const double mass = device.moving_mass_kg();
  const Matrix rates{{{0.0, 1.0, 0.0},
                      {-stiffness_n_per_m_ / mass, -device.damping_n_s_per_m() / mass, 1.0 / mass},
                      {0.0, 0.0, 0.0}}};
  const std::size_t levels =
      coulomb_n_ > 0.0 ? levels_.size() : 1;  // without friction nothing looks for its rest
  for (std::size_t level = 0; level < levels; ++level) {
    const Matrix e = exponential(rates, std::ldexp(time_s, -static_cast<int>(level)));
    levels_[level] = {
        .xx = e[0][0], .xv = e[0][1], .xf = e[0][2], .vx = e[1][0], .vv = e[1][1], .vf = e[1][2]};
  }
}

AxisMotion FreeMotion::through_rest(AxisMotion motion, double force_n, double sign) const noexcept {
  std::size_t passed = 0;  // units of 2^-halvings
  for (std::size_t level = 1; level <= halvings; ++level) {
    const AxisMotion next = levels_[level].step(motion, force_n - sign * coulomb_n_);
    if (next.speed_m_s * sign < 0.0) continue;
    motion = next;
    passed += std::size_t{1} << (halvings - level);
  }
  motion.speed_m_s = 0.0;
  const double back = direction(motion, force_n);
  if (back == 0.0) return motion;
  const std::size_t left = (std::size_t{1} << halvings) - passed;
  for (std::size_t level = 0; level <= halvings; ++level) {
    if ((left >> (halvings - level) & 1U) != 0U)
      motion = levels_[level].step(motion, force_n - back * coulomb_n_);
  }
  return motion;
}

}  // namespace kerf::bench

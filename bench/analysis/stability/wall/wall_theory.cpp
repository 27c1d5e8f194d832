#include "stability/wall/wall_theory.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "stability/bisection.h"
#include "stability/device/sampled_loop.h"

namespace kerf::bench {

double colgate_schenkel(const SampledDevice& device, double wall_damping) {
  return std::max(0.0, 2.0 * (device.viscous_n_s_per_m - std::abs(wall_damping)) / device.period_s);
}

double abbott_okamura(const SampledDevice& device) {
  const double by_damping = 2.0 * device.viscous_n_s_per_m / device.period_s;
  if (device.encoder_step_m == 0.0) return by_damping;
  return std::min(by_damping, 2.0 * device.coulomb_n / device.encoder_step_m);
}

double friction_needed(const SampledDevice& device, double angle, std::complex<double> wall) {
  const double delay = whole_periods(device.delay_s, device.period_s);
  const std::complex<double> held = (1.0 - std::polar(1.0, -angle)) * std::polar(1.0, -angle * delay);
  return 0.5 * device.period_s / (1.0 - std::cos(angle)) * (held * wall).real();
}

PassiveWalls::PassiveWalls(const SampledDevice& device) : viscous_n_s_per_m_(device.viscous_n_s_per_m) {
  constexpr int frequencies = 2000;
  using Complex = std::complex<double>;
  const double gain = device.velocity_gain();
  for (int i = 1; i <= frequencies; ++i) {
    const double angle = std::numbers::pi * i / frequencies;  // w T
    const Complex back = std::polar(1.0, -angle);
    const Complex damper = gain * (1.0 - back) / (device.period_s * (1.0 - (1.0 - gain) * back));
    needs_.push_back({friction_needed(device, angle, 1.0), friction_needed(device, angle, damper)});
  }
}

double PassiveWalls::stiffness(double wall_damping) const {
  double stiffest = std::numeric_limits<double>::infinity();
  for (const Needs& needs : needs_) {
    const double left = viscous_n_s_per_m_ - wall_damping * needs.of_damping;
    if (left <= 0.0) return 0.0;
    if (needs.of_stiffness > 0.0) stiffest = std::min(stiffest, left / needs.of_stiffness);
  }
  return stiffest;
}

double PassiveWalls::worst_of_damping() const {
  double most = 0.0;
  for (const Needs& needs : needs_) most = std::max(most, needs.of_damping);
  return most;
}

double passive_stiffness(const SampledDevice& device, double wall_damping) {
  return PassiveWalls(device).stiffness(wall_damping);
}

double worst_of_damping(const SampledDevice& device) { return PassiveWalls(device).worst_of_damping(); }

namespace {

/// The sampled system of a wall on a device, tick to tick.
Eigen::MatrixXd system_of(const SampledDevice& device, const DeviceMotion& moves, const Wall& wall) {
  // x, v, last reading, filtered velocity, what the motor holds, commands on their way from the newest on.
  enum Place : Eigen::Index { place, speed, reading, velocity, held, first_command };
  const auto commands = static_cast<Eigen::Index>(moves.delay.ticks);
  const Eigen::Index size = first_command + commands;
  using Row = Eigen::RowVectorXd;
  const auto unit = [&](Eigen::Index at) -> Row { return Row::Unit(size, at); };

  const double gain = device.velocity_gain();
  const Row filtered = (1.0 - gain) * unit(velocity) + gain / device.period_s * (unit(place) - unit(reading));
  const Row command = -wall.stiffness_n_per_m * unit(place) - wall.damping_n_s_per_m * filtered;
  const Row arrived = commands == 0 ? command : unit(first_command + commands - 1);
  Row x = unit(place);
  Row v = unit(speed);
  const auto move = [&](const FreeMotion::Transition& by, const Row& force) {
    const Row x_then = by.xx * x + by.xv * v + by.xf * force;
    v = Row(by.vx * x + by.vv * v + by.vf * force);
    x = x_then;
  };
  if (moves.delay.share > 0.0) move(moves.before.transition(), unit(held));
  move(moves.after.transition(), arrived);

  Eigen::MatrixXd system(size, size);
  system.row(place) = x;
  system.row(speed) = v;
  system.row(reading) = unit(place);
  system.row(velocity) = filtered;
  system.row(held) = arrived;
  for (Eigen::Index i = 0; i < commands; ++i) {
    system.row(first_command + i) = i == 0 ? command : unit(first_command + i - 1);
  }
  return system;
}

}  // namespace

SampledSystem::SampledSystem(const SampledDevice& device) {
  constexpr double much = 1e6;  // a difference that loses no digits
  SampledDevice smooth = device;
  smooth.coulomb_n = 0.0;
  const DeviceMotion moves(smooth);
  free_ = system_of(smooth, moves, {});
  of_stiffness_ = (system_of(smooth, moves, {.stiffness_n_per_m = much}) - free_) / much;
  of_damping_ = (system_of(smooth, moves, {.damping_n_s_per_m = much}) - free_) / much;
  std::vector<Eigen::Index> read;  // places of the state that a tick asks for; the others have eigenvalue 0
  for (Eigen::Index k = 0; k < free_.cols(); ++k) {
    const auto is_read = [&](const Eigen::MatrixXd& matrix) { return (matrix.col(k).array() != 0.0).any(); };
    if (is_read(free_) || is_read(of_stiffness_) || is_read(of_damping_)) read.push_back(k);
  }
  for (Eigen::MatrixXd* const part : {&free_, &of_stiffness_, &of_damping_})
    *part = Eigen::MatrixXd((*part)(read, read));
}

double SampledSystem::spectral_radius(const Wall& wall) const {
  const Eigen::MatrixXd system =
      free_ + wall.stiffness_n_per_m * of_stiffness_ + wall.damping_n_s_per_m * of_damping_;
  return Eigen::EigenSolver<Eigen::MatrixXd>(system, false).eigenvalues().cwiseAbs().maxCoeff();
}

double spectral_radius(const SampledDevice& device, const Wall& wall) {
  return SampledSystem(device).spectral_radius(wall);
}

double eigenvalue_boundary(const SampledDevice& device, double wall_damping, double softest,
                           double stiffest) {
  return eigenvalue_boundary(SampledSystem(device), wall_damping, softest, stiffest);
}

double eigenvalue_boundary(const SampledSystem& system, double wall_damping, double softest,
                           double stiffest) {
  return first_change({.lower = softest, .upper = stiffest, .share = 1e-6}, [&](double stiffness) {
    return system.spectral_radius({.stiffness_n_per_m = stiffness, .damping_n_s_per_m = wall_damping}) < 1.0;
  });
}

}  // namespace kerf::bench

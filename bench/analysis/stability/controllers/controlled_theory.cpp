#include "stability/controllers/controlled_theory.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "stability/bisection.h"

namespace kerf::bench {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t memory_numbers = sizeof(ControlledWall::Memory) / sizeof(double);
using MemoryNumbers = std::array<double, memory_numbers>;
static_assert(sizeof(MemoryNumbers) == sizeof(ControlledWall::Memory));

/// The state between two ticks, as it stands in a vector.
struct State {
  AxisMotion motion;
  double held_n = 0.0;
  double last_m = 0.0;  ///< as the sensor read it
  double speed_m_s = 0.0;
  std::vector<double> on_the_way;  ///< from the newest on
  ControlledWall::Memory memory;
};

constexpr Eigen::Index of_plant = 3;
constexpr Eigen::Index of_sensor = 2;

Eigen::Index size_of(std::size_t delay_ticks) {
  return of_plant + of_sensor + static_cast<Eigen::Index>(delay_ticks + memory_numbers);
}

State state_from(const Eigen::VectorXd& numbers, std::size_t delay_ticks) {
  const double* at = numbers.data();
  State state;
  state.motion.position_m = *at++;
  state.motion.speed_m_s = *at++;
  state.held_n = *at++;
  state.last_m = *at++;
  state.speed_m_s = *at++;
  state.on_the_way.assign(at, at + delay_ticks);
  at += delay_ticks;
  MemoryNumbers memory{};
  std::copy_n(at, memory_numbers, memory.begin());
  state.memory = std::bit_cast<ControlledWall::Memory>(memory);
  return state;
}

Eigen::VectorXd numbers_of(const State& state) {
  Eigen::VectorXd numbers(size_of(state.on_the_way.size()));
  numbers.head(of_plant + of_sensor) << state.motion.position_m, state.motion.speed_m_s, state.held_n,
      state.last_m, state.speed_m_s;
  double* at = std::ranges::copy(state.on_the_way, numbers.data() + of_plant + of_sensor).out;
  std::ranges::copy(std::bit_cast<MemoryNumbers>(state.memory), at);
  return numbers;
}

/// Sensor and controller at a position: the force, with what they remember moved on.
double rendered(ControlledWall& wall, const SampledDevice& device, State& state, double position_m) {
  const double difference = (position_m - state.last_m) / device.period_s;
  state.speed_m_s += device.velocity_gain() * (difference - state.speed_m_s);
  state.last_m = position_m;
  return wall.step_from(state.memory, {.position_m = position_m, .speed_m_s = state.speed_m_s});
}

/// The places of a state on which those that are asked for depend, in any number of ticks. The others come to
/// nothing, as what a controller has no use for and carries on.
std::vector<Eigen::Index> asked_for(const Eigen::MatrixXd& matrix, std::vector<bool> asked) {
  for (bool grows = true; grows;) {
    grows = false;
    for (Eigen::Index of = 0; of < matrix.rows(); ++of) {
      if (!asked[static_cast<std::size_t>(of)]) continue;
      for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
        if (matrix(of, k) == 0.0 || asked[static_cast<std::size_t>(k)]) continue;
        asked[static_cast<std::size_t>(k)] = true;
        grows = true;
      }
    }
  }
  std::vector<Eigen::Index> places;
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    if (asked[static_cast<std::size_t>(k)]) places.push_back(k);
  }
  return places;
}

}  // namespace

ControlledSystem::ControlledSystem(const ControllerDesign& design, const SampledDevice& device,
                                   const Wall& wall)
    : device_(device) {
  check(device);
  device_.coulomb_n = device_.encoder_step_m = 0.0;
  ControlledWall controlled(design);
  if (!controlled.is_linear()) throw std::invalid_argument("a passivity controller has no eigenvalues");
  controlled.begin(wall);
  const DeviceMotion moves(device_);
  const std::size_t delay_ticks = moves.delay.ticks;
  const Eigen::Index size = size_of(delay_ticks);
  system_.resize(size, size);
  Eigen::MatrixXd controller(size, size);
  Eigen::RowVectorXd to_force(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    State state = state_from(Eigen::VectorXd::Unit(size, k), delay_ticks);
    State open = state;
    to_force[k] = k < of_plant ? 0.0 : rendered(controlled, device_, open, 0.0);
    controller.col(k) = numbers_of(open);

    double arrived_n = rendered(controlled, device_, state, state.motion.position_m);
    if (!state.on_the_way.empty()) {
      state.on_the_way.insert(state.on_the_way.begin(), arrived_n);
      arrived_n = state.on_the_way.back();
      state.on_the_way.pop_back();
    }
    AxisMotion at = state.motion;
    if (moves.delay.share > 0.0) at = moves.before.transition().step(at, state.held_n);
    state.motion = moves.after.transition().step(at, arrived_n);
    state.held_n = arrived_n;
    system_.col(k) = numbers_of(state);
  }
  State fed = state_from(Eigen::VectorXd::Zero(size), delay_ticks);
  through_ = rendered(controlled, device_, fed, 1.0);
  const Eigen::VectorXd from_position = numbers_of(fed);

  std::vector<bool> moves_it(static_cast<std::size_t>(size), false);
  moves_it[0] = moves_it[1] = true;
  const auto all = asked_for(system_, moves_it);
  system_ = Eigen::MatrixXd(system_(all, all));
  std::vector<bool> forces(static_cast<std::size_t>(size), false);
  for (Eigen::Index k = 0; k < size; ++k) forces[static_cast<std::size_t>(k)] = to_force[k] != 0.0;
  const auto own = asked_for(controller, forces);
  controller_ = Eigen::MatrixXd(controller(own, own));
  from_position_ = Eigen::VectorXd(from_position(own));
  to_force_ = Eigen::RowVectorXd(to_force(own));
}

double ControlledSystem::spectral_radius() const {
  return Eigen::EigenSolver<Eigen::MatrixXd>(system_, false).eigenvalues().cwiseAbs().maxCoeff();
}

Complex ControlledSystem::force_per_position(double angle) const {
  if (controller_.rows() == 0) return -through_;
  Eigen::MatrixXcd resolvent = -controller_.cast<Complex>();
  resolvent.diagonal().array() += std::polar(1.0, angle);
  const Eigen::VectorXcd state = resolvent.partialPivLu().solve(from_position_.cast<Complex>());
  return -((to_force_.cast<Complex>() * state)(0) + through_);
}

Complex hold_and_delay(const SampledDevice& device, double frequency_hz) {
  const Complex jw(0.0, 2.0 * std::numbers::pi * frequency_hz);
  return std::exp(-jw * device.delay_s) * (1.0 - std::exp(-jw * device.period_s)) / (jw * device.period_s);
}

Complex ControlledSystem::loop_impedance(double frequency_hz) const {
  const double turn = 2.0 * std::numbers::pi * frequency_hz;
  return force_per_position(turn * device_.period_s) * hold_and_delay(device_, frequency_hz) /
         Complex(0.0, turn);
}

bool ControlledSystem::is_passive() const {
  constexpr int frequencies = 500;
  for (int i = 1; i <= frequencies; ++i) {
    const double angle = std::numbers::pi * i / frequencies;
    if (friction_needed(device_, angle, force_per_position(angle)) >= device_.viscous_n_s_per_m) return false;
  }
  return true;
}

double controlled_boundary(const ControllerDesign& design, const SampledDevice& device, double wall_damping,
                           double softest, double stiffest) {
  return first_change({.lower = softest, .upper = stiffest, .share = 1e-6}, [&](double stiffness) {
    const ControlledSystem system(design, device,
                                  {.stiffness_n_per_m = stiffness, .damping_n_s_per_m = wall_damping});
    return system.spectral_radius() < 1.0;
  });
}

double controlled_passive(const ControllerDesign& design, double wall_damping, double stiffest) {
  const auto is_passive = [&](double stiffness) {
    return ControlledSystem(design, design.device,
                            {.stiffness_n_per_m = stiffness, .damping_n_s_per_m = wall_damping})
        .is_passive();
  };
  double good = 0.0;
  double bad = stiffest;
  if (!is_passive(1e-6 * stiffest)) return 0.0;
  if (is_passive(bad)) return bad;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (good + bad);
    (is_passive(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace kerf::bench

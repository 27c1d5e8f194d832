#include "stability/several/turning_wall.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "stability/several/matrices.h"

namespace kerf::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// A product that is kept at size 1, with the logarithm of what was taken out.
struct ScaledProduct {
  MatrixXd product;
  double logarithm = 0.0;

  void multiply(const MatrixXd& from_the_left) { take((from_the_left * product).eval()); }
  void square() {
    logarithm *= 2.0;
    take((product * product).eval());
  }
  void take(MatrixXd next) {
    const double size = next.norm();
    logarithm += std::log(size);
    product = next / size;
  }
};

double angle_of(std::size_t tick, std::size_t ticks, double rate) {
  return std::copysign(2.0 * std::numbers::pi * static_cast<double>(tick) / static_cast<double>(ticks), rate);
}

/// The ticks of a turn, one after another.
void for_each_wall(const TurningWall& wall, double period_s,
                   const std::function<void(const WallOfAxes&)>& call) {
  const std::size_t ticks = ticks_of_a_turn(wall, period_s);
  for (std::size_t tick = 0; tick < ticks; ++tick)
    call(wall_at(wall, angle_of(tick, ticks, wall.rate_rad_s)));
}

}  // namespace

MatrixXd rotation_in_plane(Index axes, Index first, Index second, double angle_rad) {
  MatrixXd turn = MatrixXd::Identity(axes, axes);
  turn(first, first) = turn(second, second) = std::cos(angle_rad);
  turn(second, first) = std::sin(angle_rad);
  turn(first, second) = -std::sin(angle_rad);
  return turn;
}

WallOfAxes wall_at(const TurningWall& wall, double angle_rad) {
  const Index axes = wall.wall.stiffness.rows();
  WallOfAxes at = wall.wall;
  if (axes > 1) {
    const MatrixXd turn = rotation_in_plane(axes, wall.first_axis, wall.second_axis, angle_rad);
    at.stiffness = (turn * at.stiffness * turn.transpose()).eval();
    at.damping = (turn * at.damping * turn.transpose()).eval();
  }
  if (wall.drags) {
    MatrixXd quarter = MatrixXd::Zero(axes, axes);
    quarter(wall.second_axis, wall.first_axis) = 1.0;
    quarter(wall.first_axis, wall.second_axis) = -1.0;
    at.stiffness -= wall.rate_rad_s * at.damping * quarter;
  }
  return at;
}

std::size_t ticks_of_a_turn(const TurningWall& wall, double period_s) {
  if (!wall.turns()) return 1;
  const double ticks = std::round(2.0 * std::numbers::pi / (std::abs(wall.rate_rad_s) * period_s));
  if (!(ticks >= 4.0 && ticks <= static_cast<double>(most_ticks_of_a_turn))) {
    throw std::invalid_argument(
        fmt::format("a tool that turns at {} rad/s takes {:.4g} ticks a turn, expected 4 to {}; give another "
                    "rate of rotation, or 0",
                    wall.rate_rad_s, ticks, most_ticks_of_a_turn));
  }
  return static_cast<std::size_t>(ticks);
}

double growth(const SystemOfAxes& system, const TurningWall& wall, double period_s) {
  if (!wall.turns()) return std::log(largest_modulus(system.tick(wall_at(wall, 0.0))));
  ScaledProduct turn{.product = MatrixXd::Identity(system.size(), system.size())};
  for_each_wall(wall, period_s, [&](const WallOfAxes& now) { turn.multiply(system.tick(now)); });
  return (turn.logarithm + std::log(largest_modulus(turn.product))) /
         static_cast<double>(ticks_of_a_turn(wall, period_s));
}

double simulated_growth(const SystemOfAxes& system, const TurningWall& wall, double period_s) {
  if (!wall.turns()) return simulated_growth(system, wall_at(wall, 0.0));
  constexpr int doublings = 36;  // of turns
  ScaledProduct motions{.product = MatrixXd::Identity(system.size(), system.size())};
  for_each_wall(wall, period_s, [&](const WallOfAxes& now) {
    MatrixXd next = motions.product;
    for (Index start = 0; start < system.size(); ++start) {
      Eigen::VectorXd state = next.col(start);
      system.step(now, state);
      next.col(start) = state;
    }
    motions.take(std::move(next));
  });
  for (int i = 0; i < doublings; ++i) motions.square();
  return std::ldexp(motions.logarithm, -doublings) / static_cast<double>(ticks_of_a_turn(wall, period_s));
}

}  // namespace kerf::bench

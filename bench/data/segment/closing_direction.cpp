#include "segment/closing_direction.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace kerf::bench {
namespace {

/// The work done along strokes that raise the position, less that along those that lower it.
double work_of_rising(const AxisMotion& motion, const std::vector<Turn>& turns) {
  double rising = 0.0;
  double falling = 0.0;
  for (std::size_t i = 1; i < turns.size(); ++i) {
    double work = 0.0;
    for (std::uint64_t row = turns[i - 1].row + 1; row <= turns[i].row; ++row) {
      work += motion.force(row) * std::abs(motion.position(row) - motion.position(row - 1));
    }
    (turns[i].closed ? rising : falling) += work;
  }
  return rising - falling;
}

/// Mean and the variance of that mean.
struct Mean {
  double value = 0.0;
  double variance = 0.0;
};
Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Mean mean;
  for (const double value : values) mean.value += value / n;
  for (const double value : values) mean.variance += std::pow(value - mean.value, 2) / (n * (n - 1.0));
  return mean;
}

/// Whether strokes up and strokes down differ in their mean force by more than they do among each other;
/// where there are too few to tell, they do.
bool differ_by_direction(const AxisMotion& motion, const std::vector<Turn>& turns) {
  constexpr std::size_t fewest = 3;
  constexpr double told = 3.0;  // standard errors
  std::vector<double> up;
  std::vector<double> down;
  for (std::size_t i = 1; i < turns.size(); ++i) {
    double work = 0.0;
    double way = 0.0;
    for (std::uint64_t row = turns[i - 1].row + 1; row <= turns[i].row; ++row) {
      const double step = std::abs(motion.position(row) - motion.position(row - 1));
      work += motion.force(row) * step;
      way += step;
    }
    if (way > 0.0) (turns[i].closed ? up : down).push_back(work / way);
  }
  if (up.size() < fewest || down.size() < fewest) return true;
  const Mean rising = mean_of(up);
  const Mean falling = mean_of(down);
  return std::abs(rising.value - falling.value) >= told * std::sqrt(rising.variance + falling.variance);
}

/// Covariance of position and how strong the force is: what is pressed into pushes the more, the deeper.
double strength_over_position(const AxisMotion& motion) {
  double position = 0.0;
  double strength = 0.0;
  double product = 0.0;
  const auto n = static_cast<double>(motion.rows());
  const double origin = motion.position(0);
  for (std::uint64_t row = 0; row < motion.rows(); ++row) {
    const double x = motion.position(row) - origin;
    const double force = std::abs(motion.force(row));
    position += x / n;
    strength += force / n;
    product += x * force / n;
  }
  return product - position * strength;
}

/// Work of the force along the whole way, as if every step went up.
double force_over_way(const AxisMotion& motion) {
  double sum = 0.0;
  for (std::uint64_t row = 1; row < motion.rows(); ++row)
    sum += motion.force(row) * std::abs(motion.position(row) - motion.position(row - 1));
  return sum;
}

}  // namespace

double direction_of_closing(const AxisMotion& motion, const std::vector<Turn>& turns) {
  // A command has the sign of the axis, and pushes out of the tissue: so much less do strokes along it cost.
  if (!motion.has_measured_force()) return force_over_way(motion) <= 0.0 ? 1.0 : -1.0;
  const double told =
      differ_by_direction(motion, turns) ? work_of_rising(motion, turns) : strength_over_position(motion);
  return told >= 0.0 ? 1.0 : -1.0;
}

}  // namespace kerf::bench

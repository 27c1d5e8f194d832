#pragma once

#include <optional>
#include <vector>

#include "ruptures/rupture_rows.h"

namespace kerf::fitting {

/// Points of force over speed: those at which tissue ruptured, and those at which it was whole.
struct RupturePoints {
  std::vector<double> speed;
  std::vector<std::size_t> ruptured;  ///< never empty where a separation is asked for
  std::vector<std::size_t> whole;     ///< by speed, in order

  void sort_whole();
};

/// A line that ruptured points lie on or above and whole ones below, by as much as can be, and what holds it
/// there:
///
///     margin(F) <= sum of weight * F over the points + constant
///
/// for any forces F, and equal for those it was found by. Below zero where there is no such line.
struct Separation {
  struct Point {
    std::size_t at;
    double weight;
  };
  RuptureLine line;
  double margin = 0.0;
  std::vector<Point> points;
  double constant = 0.0;
};

/// What of the line is held, if anything.
struct HeldLine {
  std::optional<double> per_speed{};
  std::optional<double> constant{};
};

[[nodiscard]] Separation separation_of(const RupturePoints& points, const Eigen::VectorXd& force,
                                       const HeldLine& held);

}  // namespace kerf::fitting

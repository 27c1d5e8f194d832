#pragma once

#include <vector>

#include "ruptures/separation.h"

namespace kerf::fitting {

/// Samples cut where tissue ruptures: parts that are runs of a Kelvin element, each from one rupture, relaxed
/// and at zero penetration, to the next. The row that ruptures ends one part too, without counting there,
/// where it has the force that broke the tissue.
struct RuptureParts {
  RuptureParts(const BreakingSamples& data, const RuptureRows& rows);

  Problem element{.model = "kelvin"};
  Samples samples;
  Weights weights;
  RupturePoints points;  ///< of the samples of the parts
};

/// Where a search among elements ended by which certain rows rupture and no others.
struct InCell {
  Eigen::VectorXd at;  ///< logarithms of the element
  double squares = 0.0;
  Separation separation;

  [[nodiscard]] bool is_within() const { return separation.margin > 0.0; }
  [[nodiscard]] ElementValues element() const;
};

/// Least squares of the element over the parts, under the condition that a line separates the forces of rows
/// that rupture from all others,
///
///     min sum (F - F_measured)^2   where   max_line margin(F) >= 0.
///
/// Given the rows the forces are smooth in the element; the condition is one of straight cuts, a separation
/// each, which are taken up one after another. What each costs is bounded, so that there is an answer where
/// no element fulfils them: its margin is below zero.
class RuptureCell {
 public:
  RuptureCell(const RuptureParts& parts, const RobustLoss& loss);

  /// `free`: without the condition.
  [[nodiscard]] InCell descend(const Eigen::VectorXd& start, const HeldLine& held = {}, bool free = false,
                               double tolerance = 1e-12) const;

 private:
  struct Point;
  [[nodiscard]] Sums sums_of(const Point& point) const;
  /// Those that a line may meet, or the forces beside them come to.
  [[nodiscard]] RupturePoints points_near(const Eigen::VectorXd& force) const;
  [[nodiscard]] bool look(const Eigen::VectorXd& at, const RupturePoints& points, const HeldLine& held,
                          Point& point) const;

  const RuptureParts& parts_;
  RobustLoss loss_;
  Weights all_;
  LawObjective objective_;
  double largest_;  ///< force [N]
};

}  // namespace kerf::fitting

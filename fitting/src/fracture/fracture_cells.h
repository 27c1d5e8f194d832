#pragma once

#include <utility>
#include <vector>

#include "fracture/fracture_rows.h"

namespace kerf::fitting {

/// Depths of yielding, and lengths of the crack, by which the same rows break and lie before the tip. A row
/// before which so many cracks lie that ran ahead of the tool is less deep by as many times what they are
/// longer.
struct FractureSides {
  double depth_from = 0.0;  ///< deepest whole row [m]; 0: none
  double depth_to;          ///< shallowest that breaks; infinite: none does
  double crack_from = 0.0;  ///< where depths of yielding are left between the two
  double crack_to;
  double crack = 0.0;                 ///< at which the depths are those of here
  std::vector<double> deepest_whole;  ///< by the number of cracks before
  std::vector<double> first_that_breaks;

  /// The depths of yielding at another length of the crack.
  [[nodiscard]] std::pair<double, double> depths_at(double length) const;
  /// The coordinates at another length of the crack, with a depth by which no row breaks that did not, if
  /// there is one.
  [[nodiscard]] Eigen::VectorXd moved_to(Eigen::VectorXd at, double length) const;
};

/// The same, and the rows on their sides.
struct FractureCell {
  FractureSides sides;
  FractureRows rows;
};

/// Sum of squares of a Fracture by its coordinates.
class FractureObjective final : public Objective {
 public:
  FractureObjective(const Problem& problem, const Samples& samples, const Weights& weights,
                    const RobustLoss& loss);
  [[nodiscard]] Eigen::Index size() const override { return FractureCoordinates::count; }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override;
  /// The sum alone; infinite where there is nothing.
  [[nodiscard]] double squares(const Eigen::VectorXd& at) const;
  [[nodiscard]] FractureRows rows(const Eigen::VectorXd& at) const;
  [[nodiscard]] FractureCell cell(const Eigen::VectorXd& at) const;
  [[nodiscard]] const FractureCoordinates& coordinates() const { return coordinates_; }

 private:
  template <typename Take>
  [[nodiscard]] FractureRows walked(const Eigen::VectorXd& at, Take&& take) const;

  const Problem& problem_;
  const Samples& samples_;
  const Weights& weights_;
  RobustLoss loss_;
  FractureCoordinates coordinates_;
};

/// Damped steps of Gauss and Newton within bounds, as many as they are allowed to be: what lies beyond a row
/// that comes to break is no minimum to arrive at, and a search to the last digits would go to and fro before
/// it.
[[nodiscard]] Minimum descend_by_steps(const Objective& objective, const Eigen::VectorXd& start,
                                       const Bounds& bounds, int most_steps, double tolerance = 1e-7);

/// The sum of squares within a cell, by the same coordinates but for the depth, in place of which is where it
/// lies between the least and the largest that the crack leaves it, from 0 to 1.
class CellObjective final : public Objective {
 public:
  CellObjective(const FractureCoordinates& coordinates, const FractureCell& cell)
      : coordinates_(coordinates), cell_(cell) {}
  [[nodiscard]] Eigen::Index size() const override { return FractureCoordinates::count; }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override;
  [[nodiscard]] Eigen::VectorXd inside(Eigen::VectorXd at) const;   ///< from the coordinates
  [[nodiscard]] Eigen::VectorXd outside(Eigen::VectorXd at) const;  ///< and to them
  [[nodiscard]] Bounds bounds() const;

 private:
  const FractureCoordinates& coordinates_;
  const FractureCell& cell_;
};

/// The least squares within the cell of some coordinates.
[[nodiscard]] Minimum least_in_cell(const FractureCoordinates& coordinates, const FractureCell& cell,
                                    const Eigen::VectorXd& start, int most_steps, double tolerance = 1e-7);

}  // namespace kerf::fitting

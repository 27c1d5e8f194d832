#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include <Eigen/Core>

#include "kernels/loss.h"
#include "least_squares.h"

namespace kerf::fitting {

/// Sums of a pass over samples with N columns, in the order of the samples. Two columns at a time: what a
/// packet of every processor holds.
template <int N>
class NormalSums {
 public:
  static constexpr int width = N + N % 2;
  using Row = Eigen::Matrix<double, width, 1>;

  explicit NormalSums(const RobustLoss& loss) : loss_(loss) {}

  /// One residual with its derivatives by the columns.
  void add(double residual, double weight, const Row& row) {
    if (loss_.kind == Loss::squares) {
      squares_ += weight * residual * residual;
    } else {
      const auto [rho, slope] = loss_(weight * residual * residual);
      squares_ += rho;
      weight *= slope;
    }
    const Row weighed = weight * row;
    score_ += weighed * residual;
    [&]<int... A>(std::integer_sequence<int, A...>) { (add_to_row<A>(weighed, row), ...); }
    (std::make_integer_sequence<int, width>{});
  }

  /// What was summed of some columns, in this order.
  template <typename Columns>
  void write(const Columns& columns, Sums& sums) const {
    const auto count = static_cast<Eigen::Index>(columns.size());
    sums.squares = squares_;
    sums.score.resize(count);
    sums.normal.resize(count, count);
    for (Eigen::Index a = 0; a < count; ++a) {
      const Eigen::Index at = columns[static_cast<std::size_t>(a)];
      sums.score[a] = score_[at];
      for (Eigen::Index b = 0; b < count; ++b) {
        const Eigen::Index other = columns[static_cast<std::size_t>(b)];
        sums.normal(a, b) = normal_(std::max(at, other), std::min(at, other));
      }
    }
  }

 private:
  /// Products of column A with itself and those after it; an even number of them.
  template <int A>
  void add_to_row(const Row& weighed, const Row& row) {
    constexpr int first = A - A % 2;
    constexpr int count = width - first;
    normal_.col(A).template tail<count>() += weighed[A] * row.template tail<count>();
  }

  RobustLoss loss_;
  double squares_ = 0.0;
  Row score_ = Row::Zero();
  Eigen::Matrix<double, width, width> normal_ = Eigen::Matrix<double, width, width>::Zero();
};

}  // namespace kerf::fitting

#pragma once

#include <vector>

#include <Eigen/Core>

#include "uncertainty/blocks.h"

namespace kerf::fitting {

/// A lattice filter over runs: forward and backward prediction errors of growing order, in place. Backward
/// errors stay at the row where their run began. One pass over them filters by a reflection and sums what the
/// next one follows from.
class Lattice {
 public:
  /// @param runs must outlive it
  Lattice(const Eigen::MatrixXd& series, const std::vector<Rows>& runs);

  /// Burg's, of least forward and backward errors.
  [[nodiscard]] double reflection() const noexcept;
  void apply(double reflection);

 private:
  void pass(double reflection, Eigen::Index order);

  Eigen::MatrixXd forward_;
  Eigen::MatrixXd backward_;
  const std::vector<Rows>& runs_;
  Eigen::Index order_ = 0;
  double product_ = 0.0;
  double energy_ = 0.0;
};

/// to[i] = from[i] + sum_k a[k] from[i - (k + 1) stride], k from 0 to order - 1, for `count` numbers; before
/// `from` there are as many as that asks for.
void filter_by_sum(double* to, const double* from, Eigen::Index count, Eigen::Index stride, const double* a,
                   Eigen::Index order);

}  // namespace kerf::fitting

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace kerf::fitting {

/// What a solution leaves: residuals and their derivatives, row by row in time, in runs that are independent
/// of each other (recordings, or axes of one).
struct Linearisation {
  Eigen::MatrixXd jacobian;   ///< n x p, by the free parameters on their search scale, times sqrt(weight)
  Eigen::VectorXd residuals;  ///< n, likewise
  std::vector<std::size_t> run_ends;    ///< rows [0, e0), [e0, e1), ...; empty for one run
  std::vector<std::size_t> cycle_ends;  ///< rows [0, e0), [e0, e1), ... are the cycles; empty: none are known
  std::vector<double> scale;  ///< of each parameter, what counts as a change as large as itself: 1 on a
                              ///< logarithmic scale, a typical size on a linear one; empty for ones
  Eigen::MatrixXd normal{};   ///< J^T J; empty: not formed yet
  Eigen::VectorXd score{};    ///< J^T r, formed with it
  /// What the residuals change by if the penetration of each run is larger by one standard error of its
  /// zero, times sqrt(weight); empty: all are taken for exact.
  Eigen::VectorXd contact_shift{};
};

/// Rows from `begin` to before `end`.
struct Rows {
  Eigen::Index begin;
  Eigen::Index end;
  [[nodiscard]] Eigen::Index count() const { return end - begin; }
};

/// A linearisation on an orthonormal basis of its derivatives, Q = J B, and on a coarser grid of time. One
/// block is the sum of 2^k rows over the root of their number, so that white noise keeps its variance.
struct Blocks {
  Eigen::MatrixXd basis;       ///< B, p x r: (J^T J)^+ = B B^T
  Eigen::MatrixXd rows;        ///< (r + 1) x blocks: Q^T, and the residuals as the last row
  std::vector<Rows> runs;      ///< in blocks
  Eigen::Index size = 1;       ///< rows in a block
  Eigen::MatrixXd lost;        ///< r x r, I - sum of the blocks' q q^T: what varies within blocks
  double lost_variance = 0.0;  ///< of the residuals within blocks
};

/// Directions of the parameters that the rows determine, columns of B, and the others.
struct Basis {
  Eigen::MatrixXd determined;  ///< B
  Eigen::MatrixXd null;        ///< p x (p - r): changes that the rows do not see
  std::vector<bool> lost;      ///< of each parameter: some of it lies in the null space
};
/// columns^T columns
[[nodiscard]] Eigen::MatrixXd gram(const Eigen::Ref<const Eigen::MatrixXd>& columns);
[[nodiscard]] Basis basis_of(const Eigen::MatrixXd& normal);

/// Forms J^T J and J^T r.
void form_products(Linearisation& linearisation);

/// Coarsens by octaves as long as the blocks keep all but 0.1 % (3 % of very many) of every direction of Q.
/// What a derivative is blind to, such as noise at 400 Hz under a stroke of 1 Hz, need not be modelled, and
/// an autoregression then spends its order where the derivatives live.
[[nodiscard]] Blocks coarsen(const Linearisation& linearisation, const Eigen::MatrixXd& normal,
                             const Eigen::MatrixXd& basis);

}  // namespace kerf::fitting

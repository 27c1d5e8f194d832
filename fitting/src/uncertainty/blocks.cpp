#include "uncertainty/blocks.h"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace kerf::fitting {
namespace {

using Eigen::Index;

constexpr double null_eigenvalue = 1e-13;  // of the largest, of J^T J with columns of length one
constexpr double max_lost = 1e-3;
constexpr double max_lost_of_many = 3e-2;  // while there are more blocks than `many`
constexpr Index many = 8192;               // for six directions or fewer
constexpr Index fewest_blocks = 128;

std::vector<Rows> halved(const std::vector<Rows>& runs) {
  std::vector<Rows> result;
  Index begin = 0;
  for (const Rows& run : runs) {
    result.push_back({begin, begin + run.count() / 2});
    begin = result.back().end;
  }
  return result;
}

template <typename Column>
void halve(const Column& fine, const std::vector<Rows>& runs, double* coarse) {
  const double* values = fine.data();
  for (const Rows& run : runs) {
    for (Index i = run.begin; i + 1 < run.end; i += 2) {
      *coarse++ = std::numbers::sqrt2 / 2.0 * (values[i] + values[i + 1]);
    }
  }
}

std::vector<Rows> runs_of(const Linearisation& linearisation) {
  std::vector<Rows> runs;
  Index begin = 0;
  for (const std::size_t end : linearisation.run_ends) {
    runs.push_back({begin, static_cast<Index>(end)});
    begin = runs.back().end;
  }
  if (runs.empty()) runs.push_back({0, linearisation.residuals.size()});
  return runs;
}

}  // namespace

Eigen::MatrixXd gram(const Eigen::MatrixXd& columns) {
  constexpr Index few = 8;  // for which packing them for a product of matrices costs more than the product
  if (columns.cols() <= few) {
    Eigen::MatrixXd product(columns.cols(), columns.cols());
    for (Index i = 0; i < columns.cols(); ++i) {
      for (Index j = 0; j <= i; ++j) product(i, j) = product(j, i) = columns.col(i).dot(columns.col(j));
    }
    return product;
  }
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  product.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
  return product.selfadjointView<Eigen::Lower>();
}

Basis basis_of(const Eigen::MatrixXd& normal) {
  const Index p = normal.rows();
  const Eigen::VectorXd length = normal.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = (length.array() > 0.0).select(length.cwiseInverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(scale.asDiagonal() * normal *
                                                                scale.asDiagonal());
  const Eigen::VectorXd& values = spectrum.eigenvalues();  // ascending
  const double threshold = null_eigenvalue * std::max(values.maxCoeff(), 0.0);
  const Index nulls = (values.array() <= threshold).count();
  Basis basis;
  basis.determined = scale.asDiagonal() * spectrum.eigenvectors().rightCols(p - nulls) *
                     values.tail(p - nulls).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::MatrixXd null = spectrum.eigenvectors().leftCols(nulls);
  for (Index k = 0; k < p; ++k) basis.lost.push_back(null.row(k).squaredNorm() > 1e-6);
  basis.null = (length.array() > 0.0).select(length.cwiseInverse(), 1.0).matrix().asDiagonal() * null;
  return basis;
}

Blocks coarsen(const Linearisation& linearisation, const Eigen::MatrixXd& normal,
               const Eigen::MatrixXd& basis) {
  const Index p = normal.rows();
  const Index r = basis.cols();
  const auto n = linearisation.residuals.size();
  const Index enough = std::max(fewest_blocks, 16 * r);
  std::vector<Rows> runs = runs_of(linearisation);
  Blocks blocks{.basis = basis, .lost = Eigen::MatrixXd::Zero(r, r)};
  Eigen::MatrixXd columns;  // of the level reached; none yet at the first
  while (true) {
    const std::vector<Rows> next_runs = halved(runs);
    const Index count = next_runs.back().end;
    if (count < enough) break;
    Eigen::MatrixXd next(count, p + 1);
    for (Index k = 0; k <= p; ++k) {
      if (blocks.size > 1) {
        halve(columns.col(k), runs, next.col(k).data());
      } else if (k < p) {
        halve(linearisation.jacobian.col(k), runs, next.col(k).data());
      } else {
        halve(linearisation.residuals, runs, next.col(k).data());
      }
    }
    const Eigen::MatrixXd lost = basis.transpose() * (normal - gram(next.leftCols(p))) * basis;
    // Work grows with the directions, and so does what the norm of all says of the worst of them.
    const double share = r <= 6 ? 1.0 : static_cast<double>(r) / 3.0;
    const double bearable = static_cast<double>(runs.back().end) * share > many ? max_lost_of_many : max_lost;
    if (lost.norm() > bearable * std::sqrt(share)) break;  // no eigenvalue is larger than the norm
    blocks.lost = lost;
    blocks.size *= 2;
    columns = std::move(next);
    runs = next_runs;
  }
  blocks.runs = runs;
  blocks.rows.resize(r + 1, runs.back().end);
  if (blocks.size > 1) {
    blocks.rows.topRows(r).noalias() = basis.transpose() * columns.leftCols(p).transpose();
    blocks.rows.bottomRows(1) = columns.col(p).transpose();
    blocks.lost_variance = (linearisation.residuals.squaredNorm() - columns.col(p).squaredNorm()) /
                           static_cast<double>(n - runs.back().end);
  } else {
    blocks.rows.topRows(r).noalias() = basis.transpose() * linearisation.jacobian.transpose();
    blocks.rows.bottomRows(1) = linearisation.residuals.transpose();
  }
  return blocks;
}

}  // namespace kerf::fitting

#include "uncertainty/blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>

#include "kernels/wide/packs.h"

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

KERF_WIDE_PACKETS void halve(const double* fine, Index halves, double* coarse) {
  constexpr double share = std::numbers::sqrt2 / 2.0;
  constexpr auto lanes = static_cast<Index>(wide::lanes);
  Index i = 0;
  for (; i + lanes <= halves; i += lanes) {
    const wide::Pack first = wide::load(fine + 2 * i);
    const wide::Pack second = wide::load(fine + 2 * i + lanes);
    wide::store(coarse + i, share * (__builtin_shufflevector(first, second, 0, 2, 4, 6) +
                                     __builtin_shufflevector(first, second, 1, 3, 5, 7)));
  }
  for (; i < halves; ++i) coarse[i] = share * (fine[2 * i] + fine[2 * i + 1]);
}

/// Sums over the products of each of few columns with itself and those before it: each is loaded once.
template <std::size_t Columns>
[[gnu::always_inline]] inline void add_products(const double* const* column, Index count, double* sum) {
  constexpr auto lanes = static_cast<Index>(wide::lanes);
  std::array<wide::Pack, Columns*(Columns + 1) / 2> total{};
  Index i = 0;
  for (; i + lanes <= count; i += lanes) {
    std::array<wide::Pack, Columns> value{};
    for (std::size_t a = 0; a < Columns; ++a) value[a] = wide::load(column[a] + i);
    for (std::size_t a = 0, k = 0; a < Columns; ++a) {
      for (std::size_t b = 0; b <= a; ++b, ++k) total[k] += value[a] * value[b];
    }
  }
  for (std::size_t a = 0, k = 0; a < Columns; ++a) {
    for (std::size_t b = 0; b <= a; ++b, ++k) {
      sum[k] = wide::sum(total[k]);
      for (Index rest = i; rest < count; ++rest) sum[k] += column[a][rest] * column[b][rest];
    }
  }
}

constexpr Index loaded_once = 4;  ///< columns whose sums stay in registers

KERF_WIDE_PACKETS void add_products_of(const double* const* column, std::size_t columns, Index count,
                                       double* sum) {
  switch (columns) {
    case 1:
      return add_products<1>(column, count, sum);
    case 2:
      return add_products<2>(column, count, sum);
    case 3:
      return add_products<3>(column, count, sum);
    default:
      return add_products<loaded_once>(column, count, sum);
  }
}

/// The sums over the products of each two columns of `count` rows.
Eigen::MatrixXd products_of(const std::vector<const double*>& column, Index count) {
  const auto columns = static_cast<Index>(column.size());
  Eigen::MatrixXd products(columns, columns);
  const auto all = [&](Index i) {
    return Eigen::Map<const Eigen::VectorXd>(column[static_cast<std::size_t>(i)], count);
  };
  std::array<double, loaded_once*(loaded_once + 1) / 2> sum{};
  const bool at_once = columns > 0 && columns <= loaded_once;
  if (at_once) add_products_of(column.data(), column.size(), count, sum.data());
  auto next = sum.begin();
  for (Index i = 0; i < columns; ++i) {
    for (Index j = 0; j <= i; ++j) products(i, j) = products(j, i) = at_once ? *next++ : all(i).dot(all(j));
  }
  return products;
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

Eigen::MatrixXd gram(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  constexpr Index few = 8;  // for which packing them for a product of matrices costs more than the product
  if (columns.cols() > few) {
    Eigen::MatrixXd product = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
    product.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
    return product.selfadjointView<Eigen::Lower>();
  }
  std::vector<const double*> column;
  for (Index i = 0; i < columns.cols(); ++i) column.push_back(columns.col(i).data());
  return products_of(column, columns.rows());
}

void form_products(Linearisation& linearisation) {
  const Eigen::MatrixXd& jacobian = linearisation.jacobian;
  const Index p = jacobian.cols();
  if (p >= loaded_once) {
    linearisation.normal = gram(jacobian);
    linearisation.score = jacobian.transpose() * linearisation.residuals;
    return;
  }
  std::vector<const double*> column;
  for (Index i = 0; i < p; ++i) column.push_back(jacobian.col(i).data());
  column.push_back(linearisation.residuals.data());
  const Eigen::MatrixXd products = products_of(column, jacobian.rows());
  linearisation.normal = products.topLeftCorner(p, p);
  linearisation.score = products.col(p).head(p);
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
      const double* const fine = blocks.size > 1 ? columns.col(k).data()
                                 : k < p         ? linearisation.jacobian.col(k).data()
                                                 : linearisation.residuals.data();
      for (std::size_t run = 0; run < runs.size(); ++run)
        halve(fine + runs[run].begin, next_runs[run].count(), next.col(k).data() + next_runs[run].begin);
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

#include "uncertainty/blocks.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::fitting {
namespace {

using Eigen::Index;

Eigen::MatrixXd waves(Index rows, Index columns) {
  Eigen::MatrixXd all(rows, columns);
  for (Index i = 0; i < rows; ++i) {
    for (Index k = 0; k < columns; ++k)
      all(i, k) = std::cos(0.1 * static_cast<double>((k + 1) * i)) + 0.3 * static_cast<double>(k);
  }
  return all;
}

// Up to four columns are summed at once, up to eight two by two, more by a product of matrices.
TEST(Gram, IsTheProductOfHoweverManyColumns) {
  for (const Index rows : {0, 1, 3, 4, 7, 1001}) {
    for (Index columns = 1; columns <= 10; ++columns) {
      const Eigen::MatrixXd all = waves(rows, columns);
      const Eigen::MatrixXd expected = all.transpose() * all;
      EXPECT_LE((gram(all) - expected).cwiseAbs().maxCoeff(), 1e-12 * static_cast<double>(rows + 1))
          << rows << " rows, " << columns << " columns";
      EXPECT_EQ(gram(all), gram(all).transpose()) << "is symmetric to the bit";
    }
  }
}

TEST(Gram, IsFormedWithTheScore) {
  for (Index columns = 1; columns <= 6; ++columns) {
    const Eigen::MatrixXd all = waves(501, columns + 1);
    Linearisation linear{.jacobian = all.leftCols(columns), .residuals = all.col(columns)};
    form_products(linear);
    const Eigen::VectorXd score = linear.jacobian.transpose() * linear.residuals;
    EXPECT_LE((linear.score - score).cwiseAbs().maxCoeff(), 1e-10) << columns;
    EXPECT_LE((linear.normal - gram(linear.jacobian)).cwiseAbs().maxCoeff(), 1e-10) << columns;
  }
}

// Two rows make one of the next level, each run for itself; what is left at the end of one is left out.
TEST(Blocks, AreSumsOfRowsOfOneRun) {
  const Index first = 1001;
  const Index second = 1200;
  Linearisation linear{.jacobian = Eigen::MatrixXd::Ones(first + second, 1),
                       .residuals = waves(first + second, 1),
                       .run_ends = {first, first + second}};
  form_products(linear);
  const Basis basis = basis_of(linear.normal);
  const Blocks blocks = coarsen(linear, linear.normal, basis.determined);
  ASSERT_GT(blocks.size, 1);
  ASSERT_EQ(blocks.runs.size(), 2U);
  for (const Index run : {Index{0}, Index{1}}) {
    const Rows& rows = blocks.runs[static_cast<std::size_t>(run)];
    for (Index block = rows.begin; block < rows.end; ++block) {
      const Index begin = run * first + (block - rows.begin) * blocks.size;
      const double sum = linear.residuals.segment(begin, blocks.size).sum();
      EXPECT_NEAR(blocks.rows(1, block), sum / std::sqrt(static_cast<double>(blocks.size)), 1e-12);
    }
  }
}

}  // namespace
}  // namespace kerf::fitting

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/law_kernel.h"

namespace kerf::fitting {
namespace {

/// A stroke in and out, with a force beside that of every law and samples that do not count alike.
struct Stroke {
  std::vector<models::Motion> motion;
  std::vector<double> period_s, force, weight;

  Stroke() {
    for (int i = 0; i < 200; ++i) {
      const double phase = 0.03 * i;
      motion.push_back({.penetration = 0.5 * (1.0 - std::cos(phase)), .velocity = 15.0 * std::sin(phase)});
      period_s.push_back(1e-3);
      force.push_back(1.0 + std::sin(0.7 * i));
      weight.push_back(0.5 + 0.25 * (i % 3));
    }
  }
  [[nodiscard]] RunView view() const {
    return {.motion = motion.data(),
            .period_s = period_s.data(),
            .force = force.data(),
            .weight = weight.data(),
            .count = motion.size()};
  }
};

// r'r, J'r and J'J of the residuals that a robust loss leaves: each counts by its weight and the loss's
// slope.
TEST(Kernel, SumsWhatItsRowsSayHoweverManyParametersAreSearched) {
  const Stroke stroke;
  for (const double segments : {2.0, 6.0, 12.0}) {
    const models::Options options{{"segments", segments}};
    std::vector<double> values;
    const auto knots = static_cast<int>(segments) + 1;
    for (int i = 0; i < knots; ++i) values.push_back(i / segments);
    for (int i = 0; i < knots; ++i) values.push_back(2.0 + std::cos(i));
    const std::vector<double> slope(values.size(), 1.0);
    const LawPoint point{.values = values, .slope = slope, .options = options};
    const LawKernel& kernel = kernel_of("piecewise");
    Eigen::VectorXd force(200);
    Eigen::MatrixXd jacobian(200, static_cast<Eigen::Index>(values.size()));
    ASSERT_TRUE(kernel.rows(point, stroke.view(), force, jacobian));
    for (const RobustLoss loss : {RobustLoss{}, RobustLoss{.kind = Loss::cauchy, .scale = 0.5}}) {
      Sums sums;
      ASSERT_TRUE(kernel.sums(point, stroke.view(), loss, sums));
      double squares = 0.0;
      Eigen::VectorXd score = Eigen::VectorXd::Zero(jacobian.cols());
      Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
      for (Eigen::Index i = 0; i < force.size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double residual = force[i] - stroke.force[at];
        const auto [rho, counts] = loss(stroke.weight[at] * residual * residual);
        squares += rho;
        score += stroke.weight[at] * counts * residual * jacobian.row(i).transpose();
        normal += stroke.weight[at] * counts * jacobian.row(i).transpose() * jacobian.row(i);
      }
      EXPECT_NEAR(sums.squares, squares, 1e-12 * squares) << segments;
      EXPECT_LT((sums.score - score).norm(), 1e-12 * score.norm()) << segments;
      EXPECT_LT((sums.normal - normal).norm(), 1e-12 * normal.norm()) << segments;
    }
  }
}

}  // namespace
}  // namespace kerf::fitting

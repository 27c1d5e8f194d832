#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/maxwell.h>

#include "kernels/law_kernel_of.h"

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

/// A tool that goes in and out, faster than some arms recover, with stamps of whole milliseconds.
Stroke jittering_stroke() {
  Stroke stroke;
  for (std::size_t i = 0; i < stroke.period_s.size(); ++i) {
    stroke.period_s[i] = 1e-3 * static_cast<double>(2 + (i * i) % 3);
    stroke.motion[i].penetration -= 0.2;
    if (i % 7 == 0) stroke.weight[i] = 0.0;
  }
  return stroke;
}

/// Values of a law and how it is looked at.
struct Looked {
  std::vector<double> values, slope;
  models::Options options;
  [[nodiscard]] LawPoint point() const { return {.values = values, .slope = slope, .options = options}; }
};

Looked arms(std::size_t count) {
  Looked law{.values = {2.0}, .slope = {}, .options = {{"arms", static_cast<double>(count)}}};
  for (std::size_t i = 0; i < count; ++i) law.values.push_back(1.0 + 3.0 * static_cast<double>(i));
  for (std::size_t i = 0; i < count; ++i) law.values.push_back(0.004 * std::pow(3.0, i));
  law.slope = law.values;
  return law;
}

void expect_sums_of_rows(const LawKernel& kernel, const Looked& law, const Stroke& stroke, double tolerance) {
  const auto count = static_cast<Eigen::Index>(stroke.motion.size());
  Eigen::VectorXd force(count);
  Eigen::MatrixXd jacobian(count, static_cast<Eigen::Index>(law.values.size()));
  ASSERT_TRUE(kernel.rows(law.point(), stroke.view(), force, jacobian));
  Sums sums;
  ASSERT_TRUE(kernel.sums(law.point(), stroke.view(), {}, sums));
  const Eigen::Map<const Eigen::VectorXd> measured(stroke.force.data(), count);
  const Eigen::Map<const Eigen::VectorXd> weight(stroke.weight.data(), count);
  const Eigen::VectorXd residual = force - measured;
  const Eigen::MatrixXd normal = jacobian.transpose() * weight.asDiagonal() * jacobian;
  const Eigen::VectorXd score = jacobian.transpose() * weight.asDiagonal() * residual;
  EXPECT_NEAR(sums.squares, residual.dot(weight.cwiseProduct(residual)), tolerance * sums.squares);
  EXPECT_LT((sums.score - score).norm(), tolerance * score.norm());
  EXPECT_LT((sums.normal - normal).norm(), tolerance * normal.norm());
}

// The rows of these take what follows from a period anew each time, and sums recall it.
TEST(Kernel, RecallsWhatALawDerivedFromPeriodsThatComeBack) {
  const Stroke stroke = jittering_stroke();
  for (const char* integrator : {"exact", "semi_implicit", "euler"}) {
    const Looked kelvin{.values = {5.0, 8.0, 0.05},
                        .slope = {5.0, 8.0, 0.05},
                        .options = {{"integrator", std::string(integrator)}}};
    expect_sums_of_rows(kernel_of("kelvin"), kelvin, stroke, 1e-13);
  }
  const Looked springpot{.values = {2.0, 1.0, 0.3}, .slope = {2.0, 1.0, 1.0}, .options = {}};
  expect_sums_of_rows(kernel_of("springpot"), springpot, stroke, 1e-13);
}

// Against the law itself with all its arms on dual numbers of all its parameters.
TEST(Kernel, TakesArmsOneByOneForWhatTheyAreTogetherWhateverIsHeld) {
  const Stroke stroke = jittering_stroke();
  const LawKernel& kernel = kernel_of("maxwell");
  const LawKernelOf<models::Maxwell, 14> whole;
  for (const char* integrator : {"exact", "semi_implicit", "euler"}) {
    for (std::size_t count = 1; count <= 6; ++count) {
      Looked law = arms(count);
      law.options["integrator"] = std::string(integrator);
      expect_sums_of_rows(kernel, law, stroke, 1e-13);
      const std::size_t nothing = law.values.size();
      for (std::size_t held = 0; held <= nothing; ++held) {  // the spring, a stiffness, a time; nothing
        law.slope = law.values;
        if (held < nothing) law.slope[held] = 0.0;
        Sums apart, together;
        ASSERT_TRUE(kernel.sums(law.point(), stroke.view(), {}, apart));
        ASSERT_TRUE(whole.sums(law.point(), stroke.view(), {}, together));
        ASSERT_EQ(apart.score.size(), together.score.size());
        EXPECT_NEAR(apart.squares, together.squares, 1e-13 * apart.squares) << count;
        EXPECT_LT((apart.score - together.score).norm(), 1e-13 * together.score.norm()) << count << held;
        EXPECT_LT((apart.normal - together.normal).norm(), 1e-13 * together.normal.norm()) << count << held;
      }
    }
  }
}

}  // namespace
}  // namespace kerf::fitting

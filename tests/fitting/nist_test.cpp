#include "fitting/nist/nist.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "minimise_over_kinks.h"

namespace kerf::test {
namespace {

using fitting::Minimum;

NistProblem problem_named(const std::string& name) {
  return read_nist(KERF_SOURCE_DIR "/tests/fitting/nist", name);
}

class Nist : public testing::TestWithParam<std::string> {};

TEST_P(Nist, IsSolvedToEightDigitsFromBothStarts) {
  const NistProblem problem = problem_named(GetParam());
  for (const auto& start : problem.starts) {
    const Minimum minimum = solve_nist(problem, start);
    EXPECT_TRUE(minimum.converged) << minimum.message;
    EXPECT_GE(digits(minimum.at, problem.certified), 8.0) << "from " << start.transpose();
    EXPECT_GE(digits(minimum.sums.squares, problem.squares), 8.0) << "from " << start.transpose();
  }
}

TEST_P(Nist, HasTheCertifiedStandardDeviations) {
  const NistProblem problem = problem_named(GetParam());
  fitting::Sums sums;
  fitting::Triangle triangle;
  ASSERT_TRUE(nist_objective(problem)->factor(problem.certified, sums, triangle));
  const auto degrees_of_freedom = static_cast<double>(problem.y.size() - problem.certified.size());
  const Eigen::VectorXd deviation =
      triangle.r.inverse().rowwise().norm() * std::sqrt(sums.squares / degrees_of_freedom);
  EXPECT_GE(digits(deviation, problem.deviation), 8.0) << deviation.transpose();
}

INSTANTIATE_TEST_SUITE_P(HigherDifficulty, Nist, testing::ValuesIn(nist_names()),
                         [](const auto& of) { return of.param; });

fitting::Bounds bounds_of(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  return {.lower = lower, .upper = upper};
}

/// r = (x + 1, l x^2 + x - 1), whose minimum is 0: each step of Gauss and Newton leaves |l| of the way
/// ([DennisSchnabel1996], example 10.2.4).
class LargeResiduals final : public fitting::DenseObjective {
 public:
  explicit LargeResiduals(double bend) : bend_(bend) {}
  [[nodiscard]] Eigen::Index size() const override { return 1; }
  [[nodiscard]] bool rows(const Eigen::VectorXd& at, Eigen::VectorXd& residual,
                          Eigen::MatrixXd& jacobian) const override {
    const double x = at[0];
    residual = Eigen::Vector2d(x + 1.0, bend_ * x * x + x - 1.0);
    jacobian = Eigen::Vector2d(1.0, 2.0 * bend_ * x + 1.0);
    return true;
  }

 private:
  double bend_;
};

TEST(Minimise, ComesToTheEndOfAMisfitInFewSteps) {
  const double infinite = std::numeric_limits<double>::infinity();
  const auto anywhere =
      bounds_of(Eigen::VectorXd::Constant(1, -infinite), Eigen::VectorXd::Constant(1, infinite));
  for (const double bend : {0.0, 0.5, 0.9, -0.9}) {
    const Minimum minimum = minimise(LargeResiduals(bend), Eigen::VectorXd::Constant(1, 0.2), anywhere);
    EXPECT_TRUE(minimum.converged) << minimum.message;
    EXPECT_LT(minimum.iterations, 15) << bend;
    EXPECT_NEAR(minimum.at[0], 0.0, 1e-6) << bend;
  }
}

/// A unit spring that only pushes, F = max(u - b, 0), and forces that are not zero where it begins to: the
/// sum of squares over b has a kink at every u, and is a parabola between two of them.
struct PushingSpring {
  Eigen::VectorXd u, force;

  explicit PushingSpring(int number, Eigen::Index count = 1000) : u(count), force(count) {
    const double pace = 1.0 + 0.037 * number;
    std::vector<std::pair<double, double>> points;
    for (int i = 0; i < count; ++i) {
      const double at = 2.0 * std::fmod(0.6180339887498949 * i, 1.0) - 1.0;
      points.emplace_back(at, std::max(at - 0.1, 0.0) + 0.3 * (1.0 + std::sin(std::fmod(pace * i * i, 7.0))));
    }
    std::ranges::sort(points, std::greater<>());
    for (Eigen::Index i = 0; i < count; ++i) std::tie(u[i], force[i]) = points[static_cast<std::size_t>(i)];
  }
  /// By the least of all parabolas, each between its kinks.
  [[nodiscard]] double least_squares() const {
    double least = std::numeric_limits<double>::infinity();
    double sum = 0.0;
    for (Eigen::Index k = 1; k <= u.size(); ++k) {
      sum += u[k - 1] - force[k - 1];
      const double next = k < u.size() ? u[k] : -std::numeric_limits<double>::infinity();
      least = std::min(least, squares_at(std::clamp(sum / static_cast<double>(k), next, u[k - 1])));
    }
    return least;
  }
  [[nodiscard]] double squares_at(double b) const {
    return ((u.array() - b).max(0.0) - force.array()).square().sum();
  }
};

class PushingObjective final : public fitting::DenseObjective {
 public:
  explicit PushingObjective(const PushingSpring& spring) : spring_(spring) {}
  [[nodiscard]] Eigen::Index size() const override { return 1; }
  [[nodiscard]] bool rows(const Eigen::VectorXd& at, Eigen::VectorXd& residual,
                          Eigen::MatrixXd& jacobian) const override {
    residual = (spring_.u.array() - at[0]).max(0.0) - spring_.force.array();
    jacobian = (spring_.u.array() > at[0]).select(Eigen::VectorXd::Constant(spring_.u.size(), -1.0), 0.0);
    return true;
  }

 private:
  const PushingSpring& spring_;
};

TEST(Minimise, StepsOverTheKinksOfALawThatOnlyPushes) {
  const auto bounds = bounds_of(Eigen::VectorXd::Constant(1, -2.0), Eigen::VectorXd::Constant(1, 2.0));
  int held_up = 0;
  for (int number = 0; number < 60; ++number) {
    const PushingSpring spring(number);
    const PushingObjective objective(spring);
    const double least = spring.least_squares();
    const Minimum first = minimise(objective, Eigen::VectorXd::Constant(1, 0.3), bounds);
    held_up += first.sums.squares > (1.0 + 1e-9) * least ? 1 : 0;
    const Minimum beyond = step_over_kinks(first, objective, bounds);
    EXPECT_LE(minimise(objective, beyond.at, bounds).sums.squares, (1.0 + 1e-9) * least) << number;
  }
  EXPECT_GT(held_up, 0) << "nothing to step over";
}

TEST(Minimise, StaysInItsBoundsToTheLastDigit) {
  const NistProblem problem = problem_named("BoxBOD");
  const auto objective = nist_objective(problem);
  const double infinite = std::numeric_limits<double>::infinity();
  const Minimum held = minimise(*objective, problem.starts[1],
                                bounds_of(Eigen::Vector2d(0.0, 0.6), Eigen::Vector2d(infinite, infinite)),
                                {.parameter_tolerance = 1e-12});
  EXPECT_EQ(held.at[1], 0.6);
  // With b2 held the model is linear in b1: its least squares are known in closed form.
  const Eigen::VectorXd shape = 1.0 - (-0.6 * problem.x.array()).exp();
  EXPECT_GE(digits(held.at[0], shape.dot(problem.y) / shape.squaredNorm()), 10.5);
}

TEST(Minimise, EndsInTheNearestValleyUnlessItBeginsInMany) {
  const NistProblem problem = problem_named("BoxBOD");
  const auto objective = nist_objective(problem);
  const Eigen::Vector2d infinite = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  const Minimum one = minimise(*objective, problem.starts[0], bounds_of(-infinite, infinite));
  const Minimum many = minimise_from_many(*objective, problem.starts[0], bounds_of(-infinite, infinite));
  EXPECT_GT(one.sums.squares, 5.0 * problem.squares) << "as b2 grows, the model becomes a constant";
  EXPECT_NEAR(many.sums.squares, problem.squares, 1e-6 * problem.squares);
}

TEST(Triangle, OfTheSumsIsThatOfTheResidualsWhileTheirDigitsLast) {
  const NistProblem problem = problem_named("Rat42");
  const auto objective = nist_objective(problem);
  fitting::Sums sums;
  fitting::Triangle triangle;
  ASSERT_TRUE(objective->factor(problem.certified, sums, triangle));
  const fitting::Triangle again = fitting::triangle_of(sums);
  EXPECT_TRUE((again.r.transpose() * again.r).isApprox(triangle.r.transpose() * triangle.r, 1e-12));
  EXPECT_TRUE((again.r.transpose() * again.z).isApprox(triangle.r.transpose() * triangle.z, 1e-6));
  EXPECT_NEAR(again.rest, triangle.rest, 1e-12 * triangle.rest);
}

}  // namespace
}  // namespace kerf::test

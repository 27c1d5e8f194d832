#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <kerf/models/exponential.h>
#include <kerf/models/friction.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/maxwell.h>
#include <kerf/models/springpot.h>

#include "kernels/law_kernel.h"

// Laws that are reckoned with several rows at a time, against their own step on dual numbers, row by row.

namespace kerf::fitting {
namespace {

/// Fractions of a golden rotation: numbers between 0 and 1 that never come again.
class Fractions {
 public:
  double next() { return at_ = std::fmod(at_ + 0.6180339887498949, 1.0); }
  double between(double least, double most) { return least * std::pow(most / least, next()); }

 private:
  double at_ = 0.0;
};

/// A tool that goes in and out of contact, faster than some arms recover. A row in five does not count, and
/// its force may as well be none.
struct Strokes {
  std::vector<models::Motion> motion;
  std::vector<double> period_s, force, weight;

  Strokes(std::size_t count, bool jitters) {
    Fractions fractions;
    double phase = 0.0;
    double before = 0.003;
    for (std::size_t i = 0; i < count; ++i) {
      period_s.push_back(jitters ? 1e-3 * static_cast<double>(1 + (i * i) % 3) : 1e-3);
      if (jitters && i % 4 == 0) period_s.back() += 1e-7 * static_cast<double>(i);  // more than are kept
      phase += 4.0 * period_s.back();
      const double depth = i % 50 < 3 ? before : 0.01 * (0.7 - std::cos(phase));
      motion.push_back({.penetration = depth, .velocity = (depth - before) / period_s.back()});
      before = depth;
      weight.push_back(count > 1 && i % 5 == 1 ? 0.0 : 0.5 + 0.25 * static_cast<double>(i % 3));
      force.push_back(weight.back() == 0.0 ? std::numeric_limits<double>::quiet_NaN()
                                           : 2.0 + fractions.next());
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

struct Rows {
  Eigen::VectorXd force;
  Eigen::MatrixXd jacobian;
};

/// The law's own step, of which every parameter is searched.
template <template <typename> typename Law, int N>
Rows stepped(const LawPoint& point, const Strokes& strokes) {
  using Dual = ceres::Jet<double, N>;
  std::vector<Dual> values(point.values.begin(), point.values.end());
  for (std::size_t i = 0; i < values.size(); ++i) values[i].v[static_cast<int>(i)] = point.slope[i];
  const auto law = Law<Dual>::make(values, point.options);
  typename Law<Dual>::State state;
  const auto count = static_cast<Eigen::Index>(strokes.motion.size());
  Rows rows{.force = Eigen::VectorXd(count),
            .jacobian = Eigen::MatrixXd(count, static_cast<Eigen::Index>(values.size()))};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Dual force = law.step(state, strokes.motion[at], strokes.period_s[at]);
    rows.force[i] = force.a;
    rows.jacobian.row(i) = force.v.head(rows.jacobian.cols()).transpose();
  }
  return rows;
}

Sums summed(const Rows& rows, const Strokes& strokes) {
  const Eigen::Index p = rows.jacobian.cols();
  Sums sums{.squares = 0.0, .score = Eigen::VectorXd::Zero(p), .normal = Eigen::MatrixXd::Zero(p, p)};
  for (Eigen::Index i = 0; i < rows.force.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (strokes.weight[at] == 0.0) continue;
    const double residual = rows.force[i] - strokes.force[at];
    sums.squares += strokes.weight[at] * residual * residual;
    sums.score += strokes.weight[at] * residual * rows.jacobian.row(i).transpose();
    sums.normal += strokes.weight[at] * rows.jacobian.row(i).transpose() * rows.jacobian.row(i);
  }
  return sums;
}

void expect_same_sums(const Sums& sums, const Sums& expected, const std::string& what) {
  constexpr double same = 1e-12;
  EXPECT_NEAR(sums.squares, expected.squares, same * expected.squares) << what;
  ASSERT_EQ(sums.score.size(), expected.score.size()) << what;
  for (Eigen::Index i = 0; i < expected.score.size(); ++i) {
    const double length = std::sqrt(expected.normal(i, i));
    EXPECT_NEAR(sums.score[i], expected.score[i], same * length * std::sqrt(expected.squares)) << what << i;
    for (Eigen::Index j = 0; j < expected.score.size(); ++j)
      EXPECT_NEAR(sums.normal(i, j), expected.normal(i, j), same * length * std::sqrt(expected.normal(j, j)))
          << what << i << j;
  }
}

/// All rows, or those that count alone.
void expect_same_rows(const LawKernel& kernel, const LawPoint& point, const Strokes& strokes,
                      const Rows& expected, bool only_those_that_count, const std::string& what) {
  RunView view = strokes.view();
  view.only_those_that_count = only_those_that_count;
  std::vector<Eigen::Index> asked;
  for (std::size_t i = 0; i < view.count; ++i) {
    if (view.is_row(i)) asked.push_back(static_cast<Eigen::Index>(i));
  }
  const auto count = static_cast<Eigen::Index>(asked.size());
  Rows rows{.force = Eigen::VectorXd(count), .jacobian = Eigen::MatrixXd(count, expected.jacobian.cols())};
  ASSERT_TRUE(kernel.rows(point, view, rows.force, rows.jacobian));
  const Eigen::VectorXd force = expected.force(asked);
  EXPECT_LE((rows.force - force).norm(), 1e-12 * force.norm()) << what;
  for (Eigen::Index k = 0; k < expected.jacobian.cols(); ++k) {
    const Eigen::VectorXd column = expected.jacobian.col(k)(asked);
    EXPECT_LE((rows.jacobian.col(k) - column).norm(), 1e-12 * column.norm()) << what << k;
  }
}

/// Near some values, at the ends of packets and of blocks.
template <template <typename> typename Law, int N>
void expect_the_law_itself(const std::vector<double>& near, const models::Options& options = {}) {
  const LawKernel& kernel = kernel_of(Law<double>::name);
  Fractions fractions;
  for (const std::size_t count : std::vector<std::size_t>{1, 2, 3, 4, 5, 255, 256, 257, 1023}) {
    for (const bool jitters : {false, true}) {
      const Strokes strokes(count, jitters);
      std::vector<double> values(near);
      for (double& value : values) value *= fractions.between(0.4, 1.8);
      const std::vector<double> slope(values);
      const LawPoint point{.values = values, .slope = slope, .options = options};
      const std::string what = std::string(Law<double>::name) + ", " + std::to_string(count) +
                               (jitters ? " uneven rows " : " rows ");
      const Rows expected = stepped<Law, N>(point, strokes);
      Sums sums;
      ASSERT_TRUE(kernel.sums(point, strokes.view(), {}, sums));
      expect_same_sums(sums, summed(expected, strokes), what);
      expect_same_rows(kernel, point, strokes, expected, false, what);
      expect_same_rows(kernel, point, strokes, expected, true, what);
    }
  }
}

TEST(WideKernel, OfKelvinIsItsStepByFourRows) {
  expect_the_law_itself<models::Kelvin, 3>({500.0, 800.0, 20.0});
  expect_the_law_itself<models::Kelvin, 3>({500.0, 800.0, 20.0}, {{"bilateral", true}});
}

// From an arm that is gone within a row to one that outlasts the recording.
TEST(WideKernel, OfMaxwellIsItsStepByFourRows) {
  expect_the_law_itself<models::Maxwell, 3>({500.0, 800.0, 0.02}, {{"arms", 1.0}});
  expect_the_law_itself<models::Maxwell, 7>({500.0, 800.0, 300.0, 900.0, 2e-5, 0.02, 20.0}, {{"arms", 3.0}});
  expect_the_law_itself<models::Maxwell, 13>(
      {500.0, 800.0, 300.0, 900.0, 200.0, 100.0, 50.0, 0.002, 0.02, 0.2, 1.0, 3.0, 9.0}, {{"arms", 6.0}});
}

TEST(WideKernel, OfTheExponentialIsItsStepByFourRows) {
  expect_the_law_itself<models::Exponential, 3>({0.3, 2.5, 4.0}, {{"thickness", 0.01}});
  expect_the_law_itself<models::Exponential, 2>({0.3, 2.5}, {{"thickness", 0.01}, {"viscous", false}});
  expect_the_law_itself<models::Exponential, 4>({0.3, 2.5, 4.0, -1.0},
                                                {{"thickness", 0.01}, {"offset", true}});
}

// Friction that builds up slowly, and within a row.
TEST(WideKernel, OfFrictionIsItsStepByFourRows) {
  expect_the_law_itself<models::Friction, 5>({1.0, -500.0, 4.0, 2.0, 3e-4});
  expect_the_law_itself<models::Friction, 5>({1.0, -500.0, 4.0, 2.0, 1e-6});
}

TEST(WideKernel, OfTheSpringpotIsItsStepByFourRows) {
  expect_the_law_itself<models::Springpot, 3>({500.0, 500.0, 0.5});
  expect_the_law_itself<models::Springpot, 2>({500.0, 0.5}, {{"spring", false}, {"bilateral", true}});
}

// What is held has no column, whatever the others are.
TEST(WideKernel, HasColumnsOfWhatIsSearchedAlone) {
  const Strokes strokes(300, false);
  const std::vector<double> values{500.0, 800.0, 20.0};
  const models::Options none;
  const LawPoint all{.values = values, .slope = values, .options = none};
  const std::vector<double> without_the_spring{500.0, 0.0, 20.0};
  const LawPoint some{.values = values, .slope = without_the_spring, .options = none};
  Sums of_all, of_some;
  ASSERT_TRUE(kernel_of("kelvin").sums(all, strokes.view(), {}, of_all));
  ASSERT_TRUE(kernel_of("kelvin").sums(some, strokes.view(), {}, of_some));
  const std::vector<Eigen::Index> searched{0, 2};
  EXPECT_EQ(of_some.squares, of_all.squares);
  EXPECT_TRUE(of_some.score.isApprox(of_all.score(searched), 1e-15));
  EXPECT_TRUE(of_some.normal.isApprox(of_all.normal(searched, searched), 1e-15));
}

}  // namespace
}  // namespace kerf::fitting

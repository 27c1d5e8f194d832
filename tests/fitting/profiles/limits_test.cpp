#include "profiles/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/QR>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/strokes.h"
#include "fitting/uncertainty/coverage.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const Estimate& estimate_of(const FitResult& fit, std::string_view name) {
  const auto found =
      std::ranges::find(fit.parameters, name, [](const Estimate& one) { return one.info.name; });
  if (found == fit.parameters.end()) throw std::out_of_range(std::string(name));
  return *found;
}

FitResult fitted(const std::string& model, const models::Law& tissue, const test::Path& path, double noise_n,
                 std::uint64_t seed = 11) {
  const test::Scenario scenario{"", model, tissue, path, {}};
  const auto count = static_cast<Eigen::Index>(path.size());
  return test::fitted(scenario, test::measured(scenario, test::Noise::white().draw(count, noise_n, seed)));
}

/// r_i = exp(a t_i) - y_i for y far from any exponential: half the second derivative of the sum of squares is
/// sum t^2 e^(at) (2 e^(at) - y).
class OneExponent final : public Objective {
 public:
  [[nodiscard]] Eigen::Index size() const override { return 1; }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override {
    sums = {.squares = 0.0, .score = Eigen::VectorXd::Zero(1), .normal = Eigen::MatrixXd::Zero(1, 1)};
    for (int i = 0; i < 50; ++i) {
      const double f = std::exp(at[0] * t(i));
      sums.squares += (f - y(i)) * (f - y(i));
      sums.score[0] += t(i) * f * (f - y(i));
      sums.normal(0, 0) += t(i) * t(i) * f * f;
    }
    return true;
  }
  [[nodiscard]] static double t(int i) { return 0.02 * i; }
  [[nodiscard]] static double y(int i) { return 1.0 + 2.0 * std::sin(7.0 * t(i)); }
  [[nodiscard]] static double second(double a) {
    double sum = 0.0;
    for (int i = 0; i < 50; ++i) {
      const double f = std::exp(a * t(i));
      sum += t(i) * t(i) * f * (2.0 * f - y(i));
    }
    return sum;
  }
};

TEST(Hessian, OfALawThatMisfitsHasWhatTheResidualsAdd) {
  const OneExponent objective;
  const Bounds anywhere{Eigen::VectorXd::Constant(1, -10.0), Eigen::VectorXd::Constant(1, 10.0)};
  const Minimum minimum = minimise(objective, Eigen::VectorXd::Constant(1, 0.3), anywhere);
  Sums sums;
  ASSERT_TRUE(objective.evaluate(minimum.at, sums));
  const double exact = OneExponent::second(minimum.at[0]);
  EXPECT_GT(std::abs(exact / sums.normal(0, 0) - 1.0), 0.1) << "the residuals add something";
  EXPECT_NEAR(hessian_of(objective, minimum.at, sums)(0, 0), exact, 1e-3 * exact);
}

// A fluid has no spring beside its arm, and its interval says so.
TEST(Limits, OfASpringThatIsNotThereBeginAtZero) {
  const models::Law fluid =
      models::Law::make("maxwell", std::vector<double>{1e-9, 50.0, 0.3}, {{"arms", 1.0}});
  int included = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const FitResult fit = fitted("kelvin", fluid, test::ramp_and_hold(4.0, 0.1), 0.02, seed);
    const Estimate& spring = estimate_of(fit, "parallel_stiffness");
    EXPECT_LT(spring.upper, 0.2) << "of 50 N/m in the arm";
    EXPECT_GT(spring.upper, 0.0);
    EXPECT_NEAR(estimate_of(fit, "series_stiffness").value, 50.0, 1.0);
    included += spring.lower == 0.0 && spring.p_zero > 0.025 ? 1 : 0;
  }
  EXPECT_GE(included, 17) << "one-sided, 97.5 % of them: fewer once in 3,000 times";
}

// In a short hold a slow arm and the spring beside it share what they explain: where the spring is found at
// zero the arm has to answer for it, and the intervals of the law without the spring lie beside the truth.
TEST(Limits, BesideWhatLiesAtZeroAllowForIt) {
  const std::vector<double> truth{50.0, 200.0, 200.0, 1.0, 40.0};
  const models::Options two{{"arms", 2.0}};
  const models::Law tissue = models::Law::make("maxwell", truth, two);
  std::vector<double> time_s, penetration, velocity;
  for (int i = 0; i < 1700; ++i) {
    time_s.push_back(0.005 * i);
    penetration.push_back(0.01 * std::min(1.0, time_s.back() / 0.5));
    velocity.push_back(time_s.back() < 0.5 ? 0.02 : 0.0);
  }
  test::Path path;
  for (std::size_t i = 0; i < time_s.size(); ++i)
    path.push_back({.penetration = penetration[i], .velocity = velocity[i]});
  const std::vector<double> exact = tissue.along(path, std::vector<double>(path.size(), 0.005));
  int at_zero = 0;
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const Eigen::VectorXd noise =
        test::Noise::white().draw(static_cast<Eigen::Index>(exact.size()), 0.01, seed);
    std::vector<double> force(exact);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] += noise[static_cast<Eigen::Index>(i)];
    const Series series{
        .time_s = time_s, .penetration = penetration, .velocity = velocity, .force = force, .cycle = {}};
    const FitResult result = fit("maxwell", std::vector{series}, {.law_options = two, .folds = 0});
    if (estimate_of(result, "parallel_stiffness").value > 1e-6) continue;
    ++at_zero;
    EXPECT_GE(estimate_of(result, "parallel_stiffness").upper, truth[0]);
    const Estimate& slow = estimate_of(result, "stiffness[1]");
    const Estimate& slow_time = estimate_of(result, "relaxation_time[1]");
    held += slow.lower <= truth[2] && truth[2] <= slow.upper && slow_time.lower <= truth[4] &&
                    truth[4] <= slow_time.upper
                ? 1
                : 0;
  }
  ASSERT_GE(at_zero, 4);
  EXPECT_EQ(held, at_zero);
}

// Without friction its presliding means nothing, and is fitted to the noise as well: that makes up for more
// than the noise of one number.
TEST(Limits, OfFrictionThatIsNotThereBeginAtZero) {
  int included = 0;
  int rejected = 0;
  constexpr int studies = 60;
  for (std::uint64_t seed = 1; seed <= studies; ++seed) {
    const test::Strokes strokes(2000, 0.03, models::Law::make("precontact", std::vector{300.0, 1e-6}), seed);
    const FitResult result = fit("friction", strokes.series(), {.folds = 0});
    const Estimate& coulomb = estimate_of(result, "coulomb");
    included += coulomb.lower == 0.0 || std::isinf(coulomb.lower) ? 1 : 0;
    rejected += coulomb.p_zero < 0.05 ? 1 : 0;
  }
  EXPECT_GE(included, 54) << "97.5 % of 60: fewer once in 1,000 times";
  EXPECT_LE(rejected, 9) << "5 % of 60: more once in 1,000 times";
}

TEST(Limits, OfASpringThatIsThereDoNot) {
  const FitResult fit = fitted("kelvin", test::kelvin(0.4), test::ramp_and_hold(4.0, 0.1), 0.02);
  EXPECT_EQ(estimate_of(fit, "parallel_stiffness").by, IntervalBy::wald);
  EXPECT_GT(estimate_of(fit, "parallel_stiffness").lower, 5.0);
  EXPECT_LT(estimate_of(fit, "parallel_stiffness").p_zero, 1e-9);
}

TEST(Limits, OfWhatIsWellKnownAreWaldsAndTheProfilesToo) {
  const models::Law law = models::Law::make("kelvin", std::vector<double>{8.0, 7.0, 3.0});
  const test::Strokes strokes(6000, 0.02, law);
  const FitResult fit = fitting::fit("kelvin", strokes.series(), {.folds = 0, .profile = true});
  for (std::size_t k = 0; k < 3; ++k) {
    const Estimate& estimate = fit.parameters[k];
    EXPECT_EQ(estimate.by, IntervalBy::wald) << estimate.info.name;
    EXPECT_NEAR(fit.profiles[k].lower, estimate.lower, 0.03 * (estimate.upper - estimate.lower));
    EXPECT_NEAR(fit.profiles[k].upper, estimate.upper, 0.03 * (estimate.upper - estimate.lower));
  }
}

// At a bound of the amplitude an exponent makes what is left of noise its own.
TEST(Limits, OfAnExponentWhoseAmplitudeIsNoneAreOpen) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const test::Strokes noise(20'000, 0.02, models::Law::make("precontact", std::vector{1e-9, 1e-6}), seed);
    const FitResult result = fit("exponential", noise.series(), {.folds = 0});
    const Estimate& exponent = estimate_of(result, "exponent");
    EXPECT_TRUE(std::isinf(exponent.std_error) || exponent.std_error > 0.5 * exponent.value)
        << exponent.value << " +- " << exponent.std_error;
  }
}

TEST(Limits, OfWhatTheDataDoNotSetAreOpen) {
  test::Path slow;
  for (int i = 0; i < 4000; ++i) slow.push_back({.penetration = 2.5e-5 * i, .velocity = 0.025});
  const FitResult fit = fitted("kelvin", test::kelvin(0.02), slow, 0.01);
  EXPECT_TRUE(std::isinf(estimate_of(fit, "series_stiffness").upper)) << "a dashpot alone does as well";
}

// A knot whose force is near zero is as well known as its neighbours.
TEST(Limits, OfAKnotNearZeroAreNoWarning) {
  const models::Law line = models::Law::make("exponential", std::vector<double>{1e-4, 9.0, 0.0},
                                             {{"thickness", 0.4}, {"zero_at_contact", true}});
  const test::Strokes strokes(8000, 0.02, line);
  const FitResult result =
      fit("piecewise", strokes.series(), {.law_options = {{"segments", 3.0}}, .folds = 0});
  EXPECT_LT(std::abs(estimate_of(result, "closing[0]").value), 0.02);
  EXPECT_THAT(result.warnings, Not(Contains(HasSubstr("the data"))));
}

// Gripped, not touched.
TEST(Bilateral, ElementPullsAndIsFoundAgain) {
  const models::Options gripped{{"bilateral", true}};
  const models::Law tissue = models::Law::make("kelvin", std::vector<double>{8.0, 7.0, 3.0}, gripped);
  test::Path path;
  for (int i = 0; i < 6000; ++i) {
    const double phase = 4e-3 * i;
    path.push_back({.penetration = 0.1 * std::sin(phase), .velocity = 0.4 * std::cos(phase)});
  }
  const test::Scenario scenario{"", "kelvin", tissue, path, {}};
  const auto force = test::measured(scenario, test::Noise::white().draw(6000, 0.02, 3));
  EXPECT_LT(*std::ranges::min_element(force), -0.5);
  EXPECT_THAT(test::fitted(scenario, force).warnings, Contains(HasSubstr("bilateral=true")));
  const FitResult result = test::fitted(scenario, force, gripped);
  EXPECT_THAT(result.warnings, Not(Contains(HasSubstr("only pushes"))));
  EXPECT_NEAR(result.rmse, 0.02, 1e-3);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_TRUE(test::holds(result.parameters[k], tissue.values()[k])) << result.parameters[k].info.name;
}

/// Force over a path of 600 samples, of lines through given knots, in white noise.
struct Lines {
  std::vector<double> time_s, penetration, velocity, force;

  Lines() {
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal(0.0, 0.1);
    for (int i = 0; i < 600; ++i) {
      const double t = 0.01 * i;
      time_s.push_back(t);
      penetration.push_back(0.25 * (1.0 - std::cos(2.0 * t)));
      velocity.push_back(0.5 * std::sin(2.0 * t));
      const double x = penetration.back();
      const double truth = x < 0.1    ? 3.0 * x
                           : x < 0.25 ? 0.3 + 1.3 / 0.15 * (x - 0.1)
                                      : 1.6 + 5.3 * (x - 0.25);
      force.push_back(truth + normal(random));
    }
  }
  /// What lines with these inner knots leave at their best, by a decomposition of their rows.
  [[nodiscard]] double left_by(double first, double second) const {
    Eigen::MatrixXd rows(600, 4);
    for (Eigen::Index i = 0; i < 600; ++i) {
      const double x = penetration[static_cast<std::size_t>(i)];
      rows.row(i) << 1.0, x, std::max(0.0, x - first), std::max(0.0, x - second);
    }
    const Eigen::Map<const Eigen::VectorXd> measured(force.data(), 600);
    const Eigen::VectorXd best = rows.colPivHouseholderQr().solve(measured);
    return (rows * best - measured).squaredNorm();
  }
  /// The same of the first knot, wherever the second leaves least.
  [[nodiscard]] double left_by(double first) const {
    double least = std::numeric_limits<double>::infinity();
    for (double second = 0.2; second < 0.3; second += 1e-4) least = std::min(least, left_by(first, second));
    return least;
  }
};

TEST(Limits, OfAKnotAmongFewSamplesAreWhereTheSumOfSquaresHasRisen) {
  const Lines lines;
  const Series series{.time_s = lines.time_s,
                      .penetration = lines.penetration,
                      .velocity = lines.velocity,
                      .force = lines.force,
                      .cycle = {}};
  const FitResult fit = fitting::fit("piecewise", series, {.law_options = {{"segments", 3.0}}, .folds = 0});
  const Estimate& knot = estimate_of(fit, "knot[1]");
  EXPECT_EQ(knot.by, IntervalBy::profile);
  const double least = lines.left_by(knot.value);
  const double unit = fit.correlation_time * least / 594.0;
  const auto deviation = [&](double at) { return std::sqrt((lines.left_by(at) - least) / unit); };
  const double quantile = student_t(0.95, 594.0);
  EXPECT_NEAR(deviation(knot.lower) / quantile, 1.0, 0.05);
  EXPECT_NEAR(deviation(knot.upper) / quantile, 1.0, 0.05);
  const double half = quantile * knot.std_error;
  EXPECT_GT(std::max(std::abs(deviation(knot.value - half) / quantile - 1.0),
                     std::abs(deviation(knot.value + half) / quantile - 1.0)),
            0.1)
      << "Wald's is another";
}

}  // namespace
}  // namespace kerf::fitting

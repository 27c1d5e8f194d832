#include "uncertainty/uncertainty.h"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "fitting/uncertainty/coverage.h"

namespace kerf::fitting {
namespace {

/// A linear problem in one level, or in two columns of waves.
Linearisation waves(Eigen::Index n, const Eigen::VectorXd& noise) {
  Linearisation result{.jacobian = Eigen::MatrixXd(n, 2), .residuals = noise};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double phase = 0.02 * static_cast<double>(i);
    result.jacobian.row(i) << 1.0, std::sin(phase);
  }
  const Eigen::Vector2d fitted = (result.jacobian.transpose() * result.jacobian)
                                     .ldlt()
                                     .solve(result.jacobian.transpose() * result.residuals);
  result.residuals -= result.jacobian * fitted;
  return result;
}

TEST(Uncertainty, OfWhiteNoiseIsTheTextbooks) {
  const auto data = waves(20'000, test::Noise::white().draw(20'000, 0.5, 7));
  const auto result = uncertainty_of(data, 0.95);
  EXPECT_NEAR(std::sqrt(result.covariance(0, 0)), 0.5 / std::sqrt(20'000.0),
              0.05 * 0.5 / std::sqrt(20'000.0));
  EXPECT_NEAR(std::sqrt(result.covariance(1, 1)), 0.5 / std::sqrt(10'000.0),
              0.05 * 0.5 / std::sqrt(10'000.0));
  EXPECT_NEAR(result.quantile[0], 1.96, 0.02);
  EXPECT_NEAR(result.correlation(0, 1), 0.0, 0.02);
  EXPECT_NEAR(result.correlation_time, 1.0, 0.1);
}

// A mean of n values of a first-order process of pole a has the variance s^2 (1 + a) / (1 - a) / n, and the
// amplitude of a wave of w radians a row has 2 s^2 / n times the spectrum (1 - a^2) / (1 - 2 a cos w + a^2).
TEST(Uncertainty, GrowsWithTheSpectrumWhereAParameterLooks) {
  constexpr double pole = 0.95;
  constexpr Eigen::Index n = 60'000;
  const auto noise = test::Noise::first_order("", pole).draw(n, 1.0, 3);
  const auto result = uncertainty_of(waves(n, noise), 0.95);
  const double at_wave = (1.0 - pole * pole) / (1.0 - 2.0 * pole * std::cos(0.02) + pole * pole);
  EXPECT_NEAR(result.covariance(0, 0) * n, 39.0, 0.15 * 39.0);
  EXPECT_NEAR(result.covariance(1, 1) * n, 2.0 * at_wave, 0.15 * 2.0 * at_wave);
  EXPECT_NEAR(result.correlation_time, 39.0, 0.2 * 39.0);
}

TEST(Uncertainty, IsThatOfTwoRunsTogether) {
  const auto noise = test::Noise::first_order("", 0.9).draw(20'000, 1.0, 3);
  const auto one = uncertainty_of(waves(20'000, noise), 0.95);
  auto parted = waves(20'000, noise);
  parted.run_ends = {10'000, 20'000};
  const auto two = uncertainty_of(parted, 0.95);
  EXPECT_NEAR(two.covariance(0, 0), one.covariance(0, 0), 0.05 * one.covariance(0, 0));
}

TEST(Uncertainty, OfManyShortRunsIsThatOfWhiteNoise) {
  auto data = waves(3'000, test::Noise::white().draw(3'000, 0.5, 7));
  for (std::size_t end = 3; end <= 3'000; end += 3) data.run_ends.push_back(end);
  const auto result = uncertainty_of(data, 0.95);
  EXPECT_NEAR(std::sqrt(result.covariance(0, 0)), 0.5 / std::sqrt(3'000.0), 0.1 * 0.5 / std::sqrt(3'000.0));
}

/// A level and its residuals, in cycles of 40 rows each of which is off by a step of its own.
Linearisation level_in_cycles(Eigen::Index cycles) {
  constexpr Eigen::Index rows = 40;
  Linearisation result{.jacobian = Eigen::MatrixXd::Ones(cycles * rows, 1),
                       .residuals = test::Noise::white().draw(cycles * rows, 0.3, 9)};
  const Eigen::VectorXd steps = test::Noise::white().draw(cycles, 1.0, 4);
  for (Eigen::Index c = 0; c < cycles; ++c) {
    result.residuals.segment(c * rows, rows).array() += steps[c];
    result.cycle_ends.push_back(static_cast<std::size_t>((c + 1) * rows));
  }
  result.residuals.array() -= result.residuals.mean();
  return result;
}

// The level is the mean of the cycles' means, and their variance over their number is its own.
TEST(Uncertainty, OfEightCyclesAndMoreIsThatOfTheirMeans) {
  const auto data = level_in_cycles(8);
  const auto result = uncertainty_of(data, 0.95);
  Eigen::VectorXd mean(8);
  for (Eigen::Index c = 0; c < 8; ++c) mean[c] = data.residuals.segment(40 * c, 40).mean();
  EXPECT_TRUE(result.by_cycles);
  EXPECT_NEAR(result.covariance(0, 0), mean.squaredNorm() / 7.0 / 8.0, 1e-12);
  EXPECT_NEAR(result.degrees_of_freedom[0], 7.0, 1e-9);
  EXPECT_NEAR(result.quantile[0], 2.364624, 1e-6) << "Student's t of 7, by R's qt(0.975, 7)";
  EXPECT_FALSE(uncertainty_of(level_in_cycles(7), 0.95).by_cycles);
}

// What a law misfits in each cycle alike is no noise.
TEST(Uncertainty, OfCyclesDoesNotGrowWithAMisfitThatRepeats) {
  auto data = level_in_cycles(20);
  const double before = uncertainty_of(data, 0.95).covariance(0, 0);
  for (Eigen::Index i = 0; i < data.residuals.size(); ++i)
    data.residuals[i] += 5.0 * std::sin(2.0 * M_PI * static_cast<double>(i % 40) / 40.0);
  EXPECT_NEAR(uncertainty_of(data, 0.95).covariance(0, 0), before, 1e-9 * before);
}

// F = k x: with x off by e, known to s, the stiffness moves by k s sum(x) / sum(x^2); of two runs each by its
// own share. The quantile is that of the normal law where this is all there is.
TEST(Uncertainty, OfWhereThePenetrationIsZeroMovesAStiffnessByItsShare) {
  constexpr Eigen::Index n = 2000;
  Linearisation spring{.jacobian = Eigen::VectorXd::LinSpaced(n, 0.5, 1.5),
                       .residuals = test::Noise::white().draw(n, 1e-6, 5)};
  const Eigen::VectorXd x = spring.jacobian;
  const auto exact = uncertainty_of(spring, 0.95);
  spring.contact_shift = Eigen::VectorXd::Constant(n, 0.1);
  const auto one = uncertainty_of(spring, 0.95);
  const double whole = 0.1 * x.sum() / x.squaredNorm();
  EXPECT_NEAR(one.covariance(0, 0) - exact.covariance(0, 0), whole * whole, 1e-9 * whole * whole);
  EXPECT_NEAR(one.quantile[0], 1.959964, 1e-6);
  EXPECT_EQ(one.correlation_time, exact.correlation_time) << "it is no noise";

  spring.run_ends = {n / 2, n};
  const auto two = uncertainty_of(spring, 0.95);
  const double first = 0.1 * x.head(n / 2).sum() / x.squaredNorm();
  const double second = 0.1 * x.tail(n / 2).sum() / x.squaredNorm();
  EXPECT_NEAR(two.covariance(0, 0), first * first + second * second, 1e-6 * whole * whole);

  spring.contact_shift = Eigen::VectorXd::Ones(3);
  EXPECT_THROW((void)uncertainty_of(spring, 0.95), std::invalid_argument);
}

TEST(Uncertainty, OfAPerfectFitIsNone) {
  const auto result = uncertainty_of(waves(2'000, Eigen::VectorXd::Zero(2'000)), 0.95);
  EXPECT_EQ(result.covariance(0, 0), 0.0);
  EXPECT_TRUE(result.determined[0]);
  EXPECT_TRUE(result.unidentifiable.empty());
}

TEST(Uncertainty, IsInfiniteWithoutRowsToSpare) {
  const auto result = uncertainty_of(
      {.jacobian = Eigen::MatrixXd::Identity(2, 2), .residuals = Eigen::Vector2d(0.0, 0.0)}, 0.95);
  EXPECT_TRUE(std::isinf(result.covariance(0, 0)));
  EXPECT_FALSE(result.determined[0]);
}

TEST(Uncertainty, IsInfiniteForResidualsThatAreNotNumbers) {
  auto data = waves(1'000, test::Noise::white().draw(1'000, 1.0, 1));
  data.residuals[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(uncertainty_of(data, 0.95).covariance(0, 0)));
}

TEST(Uncertainty, RefusesWhatDoesNotFitTogether) {
  auto data = waves(1'000, test::Noise::white().draw(1'000, 1.0, 1));
  data.run_ends = {500};
  EXPECT_THROW((void)uncertainty_of(data, 0.95), std::invalid_argument);
  data.run_ends = {600, 500, 1000};
  EXPECT_THROW((void)uncertainty_of(data, 0.95), std::invalid_argument);
}

/// Kelvin along a path, with a little white noise.
Uncertainty of_kelvin(const test::Path& path, double time_s = 0.4) {
  const auto rendered = test::render_kelvin({std::log(8.0), std::log(7.0), std::log(7.0 * time_s)}, path);
  const auto n = static_cast<Eigen::Index>(path.size());
  return uncertainty_of({.jacobian = rendered.jacobian, .residuals = test::Noise::white().draw(n, 0.01, 5)},
                        0.95);
}
const std::vector<std::string> kelvin_names{"parallel_stiffness", "series_stiffness", "damping"};
const std::vector<bool> logarithmic(3, true);

TEST(Identifiability, OfARampAndHoldIsGood) {
  EXPECT_TRUE(of_kelvin(test::ramp_and_hold(5.0, 0.1)).unidentifiable.empty());
}

TEST(Identifiability, OfAHoldAloneLeavesTheArmUnknown) {
  const auto result = of_kelvin(test::Path(3'000, models::Motion{.penetration = 0.1, .velocity = 0.0}));
  EXPECT_EQ(result.determined, (std::vector<bool>{true, false, false}));
  EXPECT_TRUE(std::isfinite(result.covariance(0, 0)));
  EXPECT_TRUE(std::isinf(result.covariance(1, 1)));
  ASSERT_EQ(result.unidentifiable.size(), 2);
  for (const UnidentifiableDirection& each : result.unidentifiable) ASSERT_EQ(each.parts.size(), 1);
  EXPECT_EQ(result.unidentifiable[0].parts[0].first + result.unidentifiable[1].parts[0].first, 3);
  EXPECT_EQ(
      describe(result.unidentifiable[0], kelvin_names, logarithmic).find("the data say nothing about '"), 0);
}

TEST(Identifiability, OfAFastRampConfusesTheTwoSprings) {
  test::Path path;
  for (int i = 0; i < 200; ++i) path.push_back({.penetration = 5e-4 * i, .velocity = 0.5});
  const auto result = of_kelvin(path, 1e4);
  bool found = false;
  for (const UnidentifiableDirection& each : result.unidentifiable) {
    if (each.parts.size() != 2) continue;
    found = true;
    EXPECT_EQ(each.parts[0].first, 1);  // k2 +8 against k1 -7
    EXPECT_EQ(each.parts[1].first, 0);
    EXPECT_NEAR(each.parts[1].second, -7.0 / 8.0, 1e-2);
    EXPECT_EQ(describe(each, kelvin_names, logarithmic),
              "the data cannot tell 'series_stiffness' and 'parallel_stiffness' apart: +10 % of "
              "'series_stiffness', -8.75 % of 'parallel_stiffness' together leave the forces as they are");
  }
  EXPECT_TRUE(found);
}

TEST(Identifiability, OfASlowRampKnowsTheDashpotButNotItsSpring) {
  test::Path path;
  for (int i = 0; i < 20'000; ++i) path.push_back({.penetration = 5e-6 * i, .velocity = 5e-3});
  const auto result = of_kelvin(path, 0.05);
  ASSERT_EQ(result.unidentifiable.size(), 1);
  ASSERT_EQ(result.unidentifiable[0].parts.size(), 1);
  EXPECT_EQ(result.unidentifiable[0].parts[0].first, 1);
  EXPECT_EQ(describe(result.unidentifiable[0], kelvin_names, logarithmic),
            "the data hardly say anything about 'series_stiffness'");
}

TEST(Identifiability, OfAProductNamesTheProduct) {
  auto data = waves(2'000, test::Noise::white().draw(2'000, 0.1, 1));
  data.jacobian.col(0) = data.jacobian.col(1);  // toughness and width, both logarithmic
  const auto result = uncertainty_of(data, 0.95);
  EXPECT_EQ(result.determined, (std::vector<bool>{false, false}));
  ASSERT_EQ(result.unidentifiable.size(), 1);
  EXPECT_TRUE(std::isinf(result.unidentifiable[0].relative_error));
  const std::string sentence = describe(result.unidentifiable[0], {"toughness", "width"}, {true, true});
  EXPECT_EQ(sentence, "the data determine the product of 'toughness' and 'width', but neither of them");
}

TEST(Identifiability, DoesNotDependOnTheUnitOfALinearParameter) {
  auto data = waves(2'000, test::Noise::white().draw(2'000, 0.1, 1));
  data.jacobian.col(1) *= 1e-6;  // per micrometre
  data.scale = {1.0, 1e6};
  EXPECT_TRUE(uncertainty_of(data, 0.95).unidentifiable.empty());
}

// Of 150 intervals of 95 % fewer than 134 cover the truth once in 600 times, if they are right (binomial);
// more than 149 once in 240.
void expect_coverage(const test::Scenario& scenario, const test::Noise& noise, int most = 149) {
  constexpr int trials = 150;
  const std::vector<double> truth = test::targets(scenario);
  std::vector<int> covered(truth.size(), 0);
  for (int i = 0; i < trials; ++i) {
    const auto values = noise.draw(static_cast<Eigen::Index>(scenario.path.size()), 0.02,
                                   1000 + static_cast<std::uint64_t>(i));
    const auto estimates = test::run_trial(scenario, values);
    for (std::size_t k = 0; k < truth.size(); ++k) covered[k] += test::holds(estimates[k], truth[k]) ? 1 : 0;
  }
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_GE(covered[k], 134) << k;
    EXPECT_LE(covered[k], most) << k;
  }
}

test::Scenario by_hand(const std::string& model, const models::Law& tissue, double duration_s) {
  const test::HandStrokes strokes(duration_s, 0.1);
  return {"", model, tissue, strokes.path, strokes.cycle};
}

TEST(Intervals, CoverTheTruthUnderWhiteNoise) {
  expect_coverage({"", "kelvin", test::kelvin(0.4), test::ramp_and_hold(2.0, 0.1), {}}, test::Noise::white());
}
TEST(Intervals, CoverTheTruthUnderNoiseWithMemory) {
  expect_coverage({"", "kelvin", test::kelvin(0.3), test::strokes(4.0, 0.1), {}},
                  test::Noise::first_order("", 0.9));
}
TEST(Intervals, CoverTheTruthUnderAResonance) {
  expect_coverage({"", "exponential", test::exponential(), test::strokes(4.0, 0.1), {}},
                  test::Noise::resonant());
}
TEST(Intervals, CoverTheTruthUnderLowPassedNoise) {
  expect_coverage({"", "kelvin", test::kelvin(0.8), test::ramp_and_hold(4.0, 0.1), {}},
                  test::Noise::low_passed());
}
TEST(Intervals, OfCyclesCoverTheTruth) {
  expect_coverage(by_hand("kelvin", test::kelvin(0.3), 10.0), test::Noise::first_order("", 0.9));
}
// Where the penetration is zero is off by as much as is said of it: without that hardly any interval holds.
TEST(Intervals, CoverTheTruthWhereTheContactIsOffByWhatIsSaidOfIt) {
  constexpr int trials = 150;
  constexpr double error_m = 2e-3;
  const test::Scenario scenario{"", "kelvin", test::kelvin(0.3), test::strokes(4.0, 0.1), {}};
  const std::vector<double> truth = test::targets(scenario);
  const Eigen::VectorXd offsets = test::Noise::white().draw(trials, error_m, 77);
  std::vector<int> covered(truth.size(), 0);
  std::vector<int> taken_for_exact(truth.size(), 0);
  for (int i = 0; i < trials; ++i) {
    const auto noise = test::Noise::white().draw(static_cast<Eigen::Index>(scenario.path.size()), 0.02,
                                                 3000 + static_cast<std::uint64_t>(i));
    test::Scenario seen(scenario);
    for (models::Motion& motion : seen.path) motion.penetration += offsets[i];
    const std::vector<double> force = test::measured(scenario, noise);
    const auto estimates = test::fitted(seen, force, {}, error_m).parameters;
    const auto exact = test::fitted(seen, force).parameters;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      covered[k] += test::holds(estimates[k], truth[k]) ? 1 : 0;
      taken_for_exact[k] += test::holds(exact[k], truth[k]) ? 1 : 0;
    }
  }
  for (std::size_t k = 0; k < truth.size(); ++k) {
    EXPECT_GE(covered[k], 134) << k;
    EXPECT_LE(covered[k], 149) << k;
  }
  EXPECT_LE(taken_for_exact[0], 75);
}
// A law that misfits has best parameters too, and the noise alone decides how well they are known.
TEST(Intervals, OfCyclesCoverTheBestParametersOfALawThatMisfits) {
  expect_coverage(by_hand("kelvin", test::two_times(0.3), 12.0), test::Noise::white(), 150);
}

}  // namespace
}  // namespace kerf::fitting

#include "starts/arm_sums.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "starts/arm_search.h"

namespace kerf::fitting {
namespace {

Problem maxwell(std::size_t arms, bool bilateral = false) {
  const models::Options options{{"arms", static_cast<double>(arms)}, {"bilateral", bilateral}};
  const auto parameters = models::Law::parameters("maxwell", options);
  return {.model = "maxwell",
          .law_options = options,
          .parameters = parameters,
          .free = std::vector<bool>(parameters.size(), true),
          .own = std::vector<bool>(parameters.size(), false)};
}

constexpr std::size_t rows = 4000;

/// Strokes of two frequencies about a depth, at times that are not equally far apart, and the force of a law.
struct Walk {
  std::vector<double> time_s, penetration, velocity, force;

  Walk(const models::Law& law, double depth, double noise_n) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal(0.0, 1.0);
    models::Law::State state = law.initial_state();
    double before_s = -1e-3;
    for (std::size_t i = 0; i < rows; ++i) {
      const double t = 1e-3 * static_cast<double>(i) + 1e-4 * std::sin(static_cast<double>(i));
      time_s.push_back(t);
      penetration.push_back(depth + 0.3 * std::sin(5.0 * t) + 0.2 * std::sin(31.0 * t));
      velocity.push_back(1.5 * std::cos(5.0 * t) + 6.2 * std::cos(31.0 * t));
      force.push_back(
          law.step(state, models::Motion{penetration.back(), velocity.back()}, t - before_s).force +
          noise_n * normal(random));
      before_s = t;
    }
  }
  [[nodiscard]] Samples samples() const {
    const Series series{
        .time_s = time_s, .penetration = penetration, .velocity = velocity, .force = force, .cycle = {}};
    return check_series(std::span(&series, 1), {});
  }
};

models::Law law_of(const Problem& problem, const std::vector<double>& values) {
  return models::Law::make(problem.model, values, problem.law_options);
}

/// What a law leaves, of its sums.
double by_sums(const ArmProducts& products, const std::vector<double>& values) {
  const std::size_t arms = (values.size() - 1) / 2;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(1 + products.series.terms());
  force[0] = values[0];
  for (std::size_t arm = 0; arm < arms; ++arm)
    force.tail(products.series.terms()) +=
        values[1 + arm] * products.series.at(std::log(values[1 + arms + arm])).value;
  return products.squares - 2.0 * force.dot(products.right) + force.dot(products.normal * force);
}

std::vector<bool> folds_of(const ArmSums& sums, const Weights& seen) {
  const auto folds = sums.folds_of(seen);
  EXPECT_TRUE(folds);
  return folds.value_or(std::vector<bool>{});
}

LetGo between(std::size_t begin, std::size_t end) {
  LetGo let_go;
  for (std::size_t i = 0; i < rows; ++i) let_go.push_back(i >= begin && i < end ? 1 : 0);
  return let_go;
}

void expect_same(const ArmProducts& one, const ArmProducts& other) {
  EXPECT_NEAR(one.squares / other.squares, 1.0, 1e-12);
  EXPECT_LT((one.normal - other.normal).norm(), 1e-12 * other.normal.norm());
  EXPECT_LT((one.right - other.right).norm(), 1e-12 * other.right.norm());
}

TEST(ArmSums, TellWhatAnyTwoArmsLeave) {
  // Sums of what may pull are of any motion; of what may not, where it does not let go.
  for (const bool bilateral : {true, false}) {
    const Problem problem = maxwell(2, bilateral);
    const double depth = bilateral ? 0.0 : 2.0;
    const Samples samples = Walk(law_of(problem, {50.0, 20.0, 30.0, 0.05, 0.7}), depth, 0.5).samples();
    const Weights weights = all_of(samples);
    const ArmSums sums(problem, samples, weights, between(0, 0));
    const ArmProducts products = sums.of(folds_of(sums, weights), sums.expected());
    for (const double fast_s : {0.0001, 0.0013, 0.24, 3.0}) {
      for (const double slow_s : {0.0021, 0.8, 30.0}) {
        // As stiff as makes a dashpot of the fastest.
        const std::vector<double> values{45.0, 2.5 / fast_s, 33.0, fast_s, slow_s};
        const double left = squares_of(problem, samples, weights, {values});
        EXPECT_NEAR(by_sums(products, values) / left, 1.0, 1e-6) << fast_s << " s and " << slow_s << " s";
      }
    }
  }
}

TEST(ArmSums, TellHowTheForceOfAnArmChangesWithItsTime) {
  const ArmSeries series(0.001, 100.0, 0.3);
  for (const double time_s : {0.001, 0.02, 5.0, 99.0}) {
    constexpr double step = 1e-6;
    const ArmSeries::At here = series.at(std::log(time_s));
    const Eigen::VectorXd change =
        series.at(std::log(time_s) + step).value - series.at(std::log(time_s) - step).value;
    EXPECT_LT((here.slope - change / (2.0 * step)).norm(), 1e-6 * here.slope.norm());
  }
}

TEST(ArmSums, OfSomeFoldsAreThoseOfTheirSamples) {
  const Problem problem = maxwell(1);
  const Samples samples = Walk(law_of(problem, {50.0, 20.0, 0.05}), 2.0, 0.5).samples();
  const Weights seen = without_fold(samples, without_fold(samples, all_of(samples), 1), 4);
  const ArmSums of_all(problem, samples, all_of(samples), between(0, 0));
  const ArmSums of_some(problem, samples, seen, between(0, 0));
  expect_same(of_all.of(folds_of(of_all, seen), of_all.expected()),
              of_some.of(folds_of(of_some, seen), of_some.expected()));
}

TEST(ArmSums, AreTheSameWhateverTheyExpectToLetGo) {
  const Problem problem = maxwell(1);
  const Samples samples = Walk(law_of(problem, {50.0, 20.0, 0.05}), 2.0, 0.5).samples();
  const Weights seen = without_fold(samples, all_of(samples), 2);
  ArmSums sums(problem, samples, all_of(samples), between(0, 0));
  const LetGo let_go = between(1000, 1300);
  const ArmProducts by_difference = sums.of(folds_of(sums, seen), let_go);
  sums.expect(let_go);
  expect_same(sums.of(folds_of(sums, seen), let_go), by_difference);
  sums.expect(between(1200, 2500));
  expect_same(sums.of(folds_of(sums, seen), let_go), by_difference);
}

TEST(ArmSums, AreNotThoseOfOtherWeightsOrOfHalfAFold) {
  const Problem problem = maxwell(1);
  const Samples samples = Walk(law_of(problem, {50.0, 20.0, 0.05}), 2.0, 0.5).samples();
  const Weights weights = all_of(samples);
  const ArmSums sums(problem, samples, weights, between(0, 0));
  Weights heavier(weights);
  heavier[7] = 2.0;
  EXPECT_FALSE(sums.folds_of(heavier));
  Weights fewer(weights);
  fewer[7] = 0.0;
  EXPECT_FALSE(sums.folds_of(fewer));
}

/// What sums say of the force that a law makes along a walk about a depth.
LeastSums least_on(const Problem& problem, const std::vector<double>& made_by, double depth) {
  const Samples samples = Walk(law_of(problem, made_by), depth, 0.0).samples();
  const Weights weights = all_of(samples);
  const ArmSums sums(problem, samples, weights, slack(problem, samples));
  return least_by_sums(problem, samples, weights, sums, sums.expected(), 1e-8);
}

TEST(LeastSums, AreThoseOfTheLawThatMadeTheForce) {
  const std::vector<double> made_by{50.0, 20.0, 30.0, 0.02, 0.7};
  const LeastSums by_sums = least_on(maxwell(2), made_by, 2.0);
  ASSERT_TRUE(by_sums.least);
  EXPECT_TRUE(by_sums.sure);
  std::vector<double> values = by_sums.least->values[0];
  if (values[3] > values[4]) {
    std::swap(values[1], values[2]);
    std::swap(values[3], values[4]);
  }
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i] / made_by[i], 1.0, 1e-3) << i;
}

TEST(LeastSums, FindWhereTheLawLetsGo) {
  const std::vector<double> made_by{10.0, 100.0, 0.05};
  const LeastSums by_sums = least_on(maxwell(1), made_by, 0.3);
  ASSERT_TRUE(by_sums.least);
  for (std::size_t i = 0; i < made_by.size(); ++i)
    EXPECT_NEAR(by_sums.least->values[0][i] / made_by[i], 1.0, 1e-3) << i;
}

}  // namespace
}  // namespace kerf::fitting

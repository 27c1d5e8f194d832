#include "profiles/separable.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fitting/profiles/fitted_strokes.h"

namespace kerf::fitting {
namespace {

const std::vector<double> rubbing{0.4, 90.0, 1.5, 0.8, 0.002};

TEST(SeparableSums, AreThoseOfTheLaw) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const FittedStrokes strokes("friction", rubbing, "friction", 0.02);
  const LawObjective objective = strokes.objective();
  const auto sums = strokes.sums(objective);
  ASSERT_TRUE(sums);
  for (int i = 0; i < 40; ++i) {
    Eigen::VectorXd at = strokes.best();
    for (Eigen::Index k = 0; k < at.size(); ++k) at[k] += any(random) * (k == 4 ? 0.999 : std::abs(at[k]));
    Sums by_law, by_sums;
    ASSERT_TRUE(objective.evaluate(at, by_law));
    ASSERT_TRUE(sums->evaluate(at, by_sums));
    EXPECT_NEAR(by_sums.squares, by_law.squares, 1e-7 * by_law.squares);
    const double of_the_score = std::sqrt(by_law.squares * by_law.normal.trace());
    EXPECT_LT((by_sums.score - by_law.score).norm(), 1e-7 * of_the_score);
    EXPECT_LT((by_sums.normal - by_law.normal).norm(), 1e-7 * by_law.normal.norm());
  }
}

TEST(SeparableSums, BeyondTheirEndsAskTheLaw) {
  const FittedStrokes strokes("friction", rubbing, "friction", 0.02);
  const LawObjective objective = strokes.objective();
  const auto sums = strokes.sums(objective);
  ASSERT_TRUE(sums);
  for (const double way : {-3.0, -1.001, 1.001, 7.0}) {
    Eigen::VectorXd at = strokes.best();
    at[4] += way;
    Sums by_law, by_sums;
    ASSERT_TRUE(objective.evaluate(at, by_law));
    ASSERT_TRUE(sums->evaluate(at, by_sums));
    EXPECT_EQ(by_sums.squares, by_law.squares);
    EXPECT_EQ(by_sums.score, by_law.score);
    EXPECT_EQ(by_sums.normal, by_law.normal);
  }
}

TEST(SeparableSums, AreNotMadeOfOtherLaws) {
  for (const std::string law : {"kelvin", "maxwell", "precontact", "scissors_analytic"}) {
    const FittedStrokes strokes("friction", rubbing, law, 0.02);
    const LawObjective objective = strokes.objective();
    EXPECT_FALSE(strokes.sums(objective)) << law;
  }
}

void expect_same(const std::vector<Limits>& one, const std::vector<Limits>& other, double share) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].by, other[k].by) << k;
    for (const auto end : {&Limits::lower, &Limits::upper}) {
      if (std::isinf(other[k].*end)) {
        EXPECT_EQ(one[k].*end, other[k].*end) << k;
      } else {
        EXPECT_NEAR(one[k].*end, other[k].*end, share * std::abs(other[k].*end)) << k;
      }
    }
  }
}

/// A law with an error.
class Wrong final : public Objective {
 public:
  explicit Wrong(const FittedStrokes& strokes)
      : law_(strokes.problem, strokes.samples, strokes.weights, strokes.solution.values) {}
  [[nodiscard]] Eigen::Index size() const override { return law_.size(); }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override {
    const bool known = law_.evaluate(at, sums);
    sums.squares *= 1.01;
    return known;
  }

 private:
  LawObjective law_;
};

// A law that misfits, some of whose limits are profiles.
TEST(SeparableSums, LimitsByThemAreThoseByTheLaw) {
  const FittedStrokes strokes("kelvin", {500.0, 800.0, 160.0}, "friction", 0.02, 0.0);
  const std::vector<Limits> by_law = limits(strokes, {});
  EXPECT_GE(std::ranges::count(by_law, IntervalBy::profile, &Limits::by), 2);
  const LawObjective objective = strokes.objective();
  expect_same(limits(strokes, [&] { return strokes.sums(objective); }), by_law, 0.01);
}

TEST(SeparableSums, WhatIsNotSoByTheLawIsLookedForByTheLaw) {
  const FittedStrokes strokes("kelvin", {500.0, 800.0, 160.0}, "friction", 0.02, 0.0);
  expect_same(limits(strokes, [&] { return std::make_unique<const Wrong>(strokes); }), limits(strokes, {}),
              0.0);
}

}  // namespace
}  // namespace kerf::fitting

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/segmented.h>

#include "fitting/segmented/segmented_curves.h"
#include "segmented/segmented_polish.h"

namespace kerf::fitting {
namespace {

using test::CurvePoints;
using test::sampled;
using testing::HasSubstr;

constexpr double sine_turns = 2.0 * std::numbers::pi;

const auto wave = [](double x) { return std::sin(sine_turns * x); };
const auto step = [](double x) { return x < 0.37 ? 0.2 : x < 0.7 ? 1.5 : 0.6 * x; };
const auto ramp = [](double x) {
  return x < 0.31 ? 0.0 : x < 0.64 ? 3.0 * (x - 0.31) : 0.99 - 0.5 * (x - 0.64);
};

std::string refusal(const CurvePoints& points, const SegmentedOptions& options = {}) {
  try {
    (void)fit_segments(points.curve(), options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Segmented, IsTheBestOfAllChoicesOfKnotsOnAGrid) {
  int which = 0;
  for (const std::size_t cells : {12U, 15U}) {
    for (unsigned seed = 0; seed < 9; ++seed) {
      const auto points = which % 3 == 0   ? sampled(60, 0.3, seed, false, wave)
                          : which % 3 == 1 ? sampled(75, 0.1, seed, false, step)
                                           : sampled(60, 1.0, seed, false, [](double) { return 0.0; });
      ++which;
      const auto curves =
          fit_segments(points.curve(), {.max_segments = 5, .cells = cells, .polish = Polish::none});
      ASSERT_EQ(curves.size(), 5U);
      for (const auto& curve : curves) {
        const double truth = test::exhaustive_error(points, cells, curve.segments(), 4);
        EXPECT_NEAR(curve.sum_of_squares, truth, 1e-10 * truth)
            << curve.segments() << " segments, seed " << seed;
        EXPECT_TRUE(curve.optimal_on_grid);
      }
    }
  }
}

TEST(Segmented, IsTheBestOfAllChoicesForALoopToo) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const auto points =
        seed % 2 == 0 ? sampled(60, 0.3, seed, true, wave) : sampled(60, 0.2, seed, true, step);
    const auto curves =
        fit_segments(points.curve(), {.max_segments = 5, .cells = 12, .polish = Polish::none});
    ASSERT_EQ(curves.size(), 5U);
    for (const auto& curve : curves) {
      const double truth = test::exhaustive_error(points, 12, curve.segments(), 4);
      EXPECT_NEAR(curve.sum_of_squares, truth, 1e-10 * truth)
          << curve.segments() << " segments, seed " << seed;
      EXPECT_TRUE(curve.optimal_on_grid);
    }
  }
}

TEST(Segmented, PolishedBrieflyIsNoWorseThanOnTheGridAndLittleWorseThanThoroughly) {
  for (const bool loop : {false, true}) {
    const auto points = sampled(3000, 0.1, 7, loop, wave);
    const auto by = [&](Polish polish) {
      return fit_segments(points.curve(), {.max_segments = 8, .cells = 64, .polish = polish});
    };
    const auto none = by(Polish::none);
    const auto brief = by(Polish::brief);
    const auto thorough = by(Polish::thorough);
    ASSERT_EQ(brief.size(), thorough.size());
    for (std::size_t i = 0; i < brief.size(); ++i) {
      EXPECT_LE(brief[i].sum_of_squares, none[i].sum_of_squares * (1.0 + 1e-12)) << i;
      EXPECT_GE(brief[i].sum_of_squares, thorough[i].sum_of_squares * (1.0 - 1e-12)) << i;
      EXPECT_LE(brief[i].sum_of_squares, thorough[i].sum_of_squares * 1.01) << i;
      EXPECT_LE(brief[i].sum_of_squares, brief[i > 0 ? i - 1 : 0].sum_of_squares * (1.0 + 1e-12)) << i;
    }
  }
}

TEST(Segmented, HoldsOnAGridWithWeightsGapsAndRepeatedPositions) {
  auto points = sampled(80, 0.2, 3, false, wave);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    points.weight.push_back(i % 5 == 2 ? 0.0 : 0.5 + 0.1 * static_cast<double>(i % 7));
    points.x[i] = std::round(40.0 * points.x[i]) / 40.0;
    if (points.x[i] > 0.42 && points.x[i] < 0.68) points.x[i] = 0.7;
  }
  const auto curves = fit_segments(points.curve(), {.max_segments = 4, .cells = 12, .polish = Polish::none});
  ASSERT_EQ(curves.size(), 4U);
  for (const auto& curve : curves) {
    const double truth = test::exhaustive_error(points, 12, curve.segments(), 4);
    EXPECT_NEAR(curve.sum_of_squares, truth, 1e-10 * truth) << curve.segments();
  }
}

TEST(Segmented, FindsTheKnotsOfAPolygonExactly) {
  const std::vector<double> knots{0.0, 0.2137, 0.3911, 0.7345, 1.0};
  const std::vector<double> force{0.1, 0.4, 2.0, 2.3, -1.0};
  const auto points =
      sampled(1001, 0.0, 0, true, [&](double x) { return test::interpolate(knots, force, x); });
  const auto curves = fit_segments(points.curve(), {.max_segments = 6});
  ASSERT_EQ(curves.size(), 6U);
  const auto& found = curves[3];
  for (std::size_t i = 0; i < knots.size(); ++i) {
    EXPECT_NEAR(found.knots[i], knots[i], 1e-9);
    EXPECT_NEAR(found.force[0][i], force[i], 1e-8);
    EXPECT_NEAR(found.force[1][i], knots[i] - 0.4 * force[i], 1e-8);
  }
  EXPECT_LT(found.rmse, 1e-9);
  EXPECT_EQ(choose_by_bic(curves), 3U) << "what rounding leaves is no reason for more segments";
}

TEST(Segmented, FindsTheKnotsOfANoisyPolygon) {
  const auto points = sampled(4000, 0.05, 11, false, ramp);
  const auto curves = fit_segments(points.curve(), {.max_segments = 8});
  ASSERT_EQ(curves.size(), 8U);
  ASSERT_EQ(choose_by_bic(curves), 2U);
  // Standard errors of the knots by the linearised law: about 0.0012 and 0.0010.
  EXPECT_NEAR(curves[2].knots[1], 0.31, 0.005);
  EXPECT_NEAR(curves[2].knots[2], 0.64, 0.005);
  EXPECT_NEAR(curves[2].rmse, 0.05, 0.0025);
}

TEST(Segmented, ReportsTheErrorOfTheCurveThatItReturns) {
  const auto points = sampled(500, 0.1, 5, true, step);
  for (const auto& curve : fit_segments(points.curve(), {.max_segments = 7})) {
    double error = 0.0;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      const double miss =
          points.y[i] - test::interpolate(curve.knots, curve.force[points.branch[i]], points.x[i]);
      error += miss * miss;
    }
    EXPECT_NEAR(curve.sum_of_squares, error, 1e-10 * error);
    EXPECT_NEAR(curve.sum_of_squares, test::dense_error(points, curve.knots, 1), 1e-9 * error);
    EXPECT_LE(curve.sum_of_squares, curve.sum_of_squares_on_grid);
    const double n = 1000.0;
    const double p =
        2.0 * static_cast<double>(curve.segments() + 1) + static_cast<double>(curve.segments() - 1);
    EXPECT_NEAR(curve.bic, n * std::log(error / n) + (p + 1.0) * std::log(n), 1e-6);
  }
}

TEST(Segmented, IsNeverWorseWithMoreSegments) {
  for (const bool loop : {false, true}) {
    for (const double noise : {0.0, 0.3}) {
      const auto points = sampled(120, noise, 7, loop, wave);
      const auto curves = fit_segments(points.curve(), {.max_segments = 8});
      EXPECT_EQ(curves.size(), 8U);
      for (std::size_t s = 1; s < curves.size(); ++s) {
        EXPECT_EQ(curves[s].segments(), s + 1);
        EXPECT_LE(curves[s].sum_of_squares, curves[s - 1].sum_of_squares);
      }
    }
  }
}

TEST(Segmented, IsNeverWorseThanDifferentialEvolution) {
  const auto bend = [](double x) { return std::exp(4.0 * x) / 20.0; };
  const std::vector<CurvePoints> all{sampled(100, 0.0, 0, false, wave), sampled(100, 0.1, 1, false, ramp),
                                     sampled(80, 0.05, 2, false, step), sampled(100, 0.02, 3, false, bend)};
  for (const auto& points : all) {
    const auto curves = fit_segments(points.curve(), {.max_segments = 6});
    for (const std::size_t segments : {3U, 6U}) {
      const double evolved = test::evolved_error(points, segments, 4);
      EXPECT_LE(curves[segments - 1].sum_of_squares, evolved * (1.0 + 1e-9))
          << segments << " segments, above by " << curves[segments - 1].sum_of_squares / evolved - 1.0;
    }
  }
}

TEST(Segmented, IsNeverWorseThanKnotsThatAreKnownToBeGoodHoweverCoarseTheGrid) {
  // The first point alone stands out, so that a knot lies nearer to the beginning than the grid has any.
  const auto points = sampled(50, 0.2, 12, false, [](double x) { return x < 0.01 ? 2.0 : x; });
  const auto curves = fit_segments(points.curve(), {.max_segments = 6, .cells = 12, .fewest_points = 2});
  ASSERT_EQ(curves.size(), 6U);
  const double known = test::dense_error(points, {0.0, 1.0 / 49.0, 39.0 / 49.0, 0.818, 46.0 / 49.0, 1.0}, 2);
  EXPECT_LE(curves[4].sum_of_squares, known);
}

TEST(Segmented, DoesNotDependOnTheOrderOrTheUnits) {
  const auto points = sampled(400, 0.1, 8, false, step);
  CurvePoints other;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const std::size_t j = (i * 171) % points.x.size();
    other.x.push_back(1e3 + 1e-3 * points.x[j]);
    other.y.push_back(-1e5 + 100.0 * points.y[j]);
  }
  const auto one = fit_segments(points.curve(), {.max_segments = 6});
  const auto two = fit_segments(other.curve(), {.max_segments = 6});
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t s = 0; s < one.size(); ++s) {
    EXPECT_NEAR(two[s].sum_of_squares, 1e4 * one[s].sum_of_squares, 1e-4 * one[s].sum_of_squares);
  }
}

TEST(Segmented, TakesAWeightOfZeroForAbsenceAndOfTwoForTwice) {
  auto points = sampled(200, 0.1, 4, false, wave);
  auto plain = points;
  points.weight.assign(points.x.size(), 1.0);
  for (const double x : {-3.0, 0.5, 7.0}) {
    points.x.push_back(x);
    points.y.push_back(50.0);
    points.weight.push_back(0.0);
  }
  points.weight[60] = 2.0;
  plain.x.push_back(plain.x[60]);
  plain.y.push_back(plain.y[60]);
  const auto weighted = fit_segments(points.curve(), {.max_segments = 4});
  const auto repeated = fit_segments(plain.curve(), {.max_segments = 4});
  for (std::size_t s = 0; s < 4; ++s) {
    EXPECT_NEAR(weighted[s].sum_of_squares, repeated[s].sum_of_squares, 1e-9 * repeated[s].sum_of_squares);
    EXPECT_EQ(weighted[s].points, 200U);
  }
}

TEST(Segmented, CrossesAGapWithOneLine) {
  auto points = sampled(400, 0.0, 0, false, [](double x) { return std::abs(x - 0.5); });
  std::erase_if(points.x, [](double x) { return std::abs(x - 0.5) < 0.2; });
  points.y.clear();
  for (const double x : points.x) points.y.push_back(std::abs(x - 0.5));
  const auto curves = fit_segments(points.curve(), {.max_segments = 3});
  ASSERT_GE(curves.size(), 2U);
  EXPECT_NEAR(curves[1].knots[1], 0.5, 1e-9) << "where the lines on both sides meet";
  EXPECT_NEAR(curves[1].force[0][1], 0.0, 1e-9);
}

TEST(Segmented, OfAConstantForceIsAConstant) {
  const auto points = sampled(100, 0.0, 0, true, [](double) { return 0.0; });
  CurvePoints constant{
      .x = points.x, .y = std::vector<double>(points.x.size(), 2.7), .weight = {}, .branch = {}};
  const auto curves = fit_segments(constant.curve(), {.max_segments = 4});
  ASSERT_FALSE(curves.empty());
  for (const auto& curve : curves) {
    EXPECT_LT(curve.rmse, 1e-12);
    for (const double force : curve.force[0]) EXPECT_NEAR(force, 2.7, 1e-12);
  }
  EXPECT_EQ(choose_by_bic(curves), 0U);
}

TEST(Segmented, TakesTwoPointsForALine) {
  const CurvePoints points{.x = {2.0, 1.0}, .y = {5.0, 3.0}, .weight = {}, .branch = {}};
  const auto curves = fit_segments(points.curve(), {.max_segments = 3, .fewest_points = 2});
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_THAT(curves[0].knots, testing::ElementsAre(1.0, 2.0));
  EXPECT_THAT(curves[0].force[0],
              testing::ElementsAre(testing::DoubleNear(3.0, 1e-12), testing::DoubleNear(5.0, 1e-12)));
}

TEST(Segmented, LeavesOutNumbersThatThePointsDoNotCarry) {
  const auto points = sampled(20, 0.1, 2, false, wave);
  EXPECT_LE(fit_segments(points.curve(), {.max_segments = 12}).size(), 5U);
  EXPECT_GE(fit_segments(points.curve(), {.max_segments = 12}).size(), 4U);
}

TEST(Segmented, KnotsSettleInTheCornersNearThem) {
  const segmented::Points points(sampled(401, 0.0, 1, false, ramp).curve());
  const auto start = segmented::Polished{.knots = {0.0, 0.28, 0.66, 1.0}, .error = HUGE_VAL};
  const auto settled = segmented::settle(points, start, 4, 0.05, HUGE_VAL);
  ASSERT_EQ(settled.knots.size(), 4U);
  EXPECT_NEAR(settled.knots[1], 0.31, 1e-6);
  EXPECT_NEAR(settled.knots[2], 0.64, 1e-6);
  EXPECT_LT(settled.error, 1e-12);
}

TEST(Segmented, TakesBreakpointsByHand) {
  const auto points = sampled(300, 0.1, 9, true, wave);
  const auto curves = fit_segments(points.curve(), {.breakpoints = {0.25, 0.6}});
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_THAT(curves[0].knots, testing::ElementsAre(0.0, 0.25, 0.6, 1.0));
  const double truth = test::dense_error(points, {0.0, 0.25, 0.6, 1.0}, 1);
  EXPECT_NEAR(curves[0].sum_of_squares, truth, 1e-10 * truth);
}

TEST(Segmented, ChoosesTheFewestWithinALimit) {
  const auto curves = fit_segments(sampled(400, 0.02, 9, false, wave).curve(), {.max_segments = 6});
  const auto chosen = fewest_within(curves, 0.1);
  ASSERT_TRUE(chosen.has_value());
  EXPECT_LE(curves[*chosen].rmse, 0.1);
  EXPECT_GT(curves[*chosen - 1].rmse, 0.1);
  EXPECT_EQ(fewest_within(curves, curves[*chosen].rmse), chosen) << "the limit itself is within it";
  EXPECT_FALSE(fewest_within(curves, 0.001).has_value());
}

TEST(Segmented, ChoosesFewerSegmentsIfThePointsSayLess) {
  const auto curves = fit_segments(sampled(2000, 0.1, 9, false, wave).curve(), {.max_segments = 7});
  EXPECT_LT(choose_by_bic(curves, 40.0), choose_by_bic(curves));
}

TEST(Segmented, RefusesWhatCannotBeFitted) {
  const auto good = sampled(30, 0.1, 1, false, wave);
  auto points = good;
  points.y[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(points), HasSubstr("point 7 is not finite"));
  points = good;
  points.weight.assign(30, -1.0);
  EXPECT_THAT(refusal(points), HasSubstr("weight of point 0"));
  points.weight.assign(30, 0.0);
  EXPECT_THAT(refusal(points), HasSubstr("no points"));
  points = good;
  points.y.pop_back();
  EXPECT_THAT(refusal(points), HasSubstr("equally many"));
  points = good;
  points.x.assign(30, 0.4);
  EXPECT_THAT(refusal(points), HasSubstr("one position"));
  points = good;
  points.branch.assign(30, 0);
  EXPECT_THAT(refusal(points), HasSubstr("while opening"));
  points.branch.assign(30, 2);
  EXPECT_THAT(refusal(points), HasSubstr("0 (closing) or 1 (opening)"));
  EXPECT_THAT(refusal(good, {.max_segments = 17}), HasSubstr("1 to 16"));
  EXPECT_THAT(refusal(good, {.cells = 2}), HasSubstr("4 to 1,024"));
  EXPECT_THAT(refusal(good, {.fewest_points = 31}), HasSubstr("needs 31 points; there are 30"));
  EXPECT_THAT(refusal(good, {.breakpoints = {0.5, 0.4}}), HasSubstr("must increase"));
  EXPECT_THAT(refusal(good, {.breakpoints = {1.5}}), HasSubstr("between the ends"));
  EXPECT_THAT(refusal(good, {.breakpoints = {0.501, 0.502, 0.503}}),
              HasSubstr("leave the force at a knot open"));
  EXPECT_THROW((void)choose_by_bic({}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::fitting

#include "editor/segment_editor.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/segmented.h>

#include "bench/studio/editor/editor_curves.h"
#include "editor/editor_json.h"

namespace kerf::bench {
namespace {

using test::curve_along;
using test::loop_of_four;
using test::nothing;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;
using testing::ThrowsMessage;

TEST(LawError, IsNothingForTheCurveItself) {
  const LawError error = law_error(curve_along(loop_of_four()), loop_of_four());
  EXPECT_LT(error.rmse_n, 1e-14);
  EXPECT_LT(error.worst_n, 1e-14);
}

TEST(LawError, OfAnOffsetIsThatOffset) {
  Knots raised = loop_of_four();
  for (double& force : raised.closing) force += 0.25;
  for (double& force : raised.opening) force -= 0.25;
  const LawError error = law_error(curve_along(loop_of_four()), raised);
  EXPECT_NEAR(error.rmse_n, 0.25, 1e-12);
  EXPECT_NEAR(error.worst_n, 0.25, 1e-12);
}

TEST(LawError, SaysWhereAndOnWhichBranchItIsWorst) {
  EditorCurve curve = curve_along(loop_of_four());
  curve.opening[40] -= 0.5;
  const LawError error = law_error(curve, loop_of_four());
  EXPECT_NEAR(error.worst_n, 0.5, 1e-12);
  EXPECT_EQ(error.worst_penetration, curve.penetration[40]);
  EXPECT_FALSE(error.worst_is_closing);
  EXPECT_NEAR(error.rmse_n, 0.5 / std::sqrt(202.0), 1e-12);
  // 7 % of the 1.5 N that the averaged opening has there
  EXPECT_NEAR(error.worst_jnd, 0.5 / (0.07 * 1.5), 1e-9);
}

TEST(LawError, TakesTheJndAtTheRootMeanSquareForce) {
  const Knots flat{.penetration = {0.0, 0.01}, .closing = {3.0, 3.0}, .opening = {-4.0, -4.0}};
  Knots off = flat;
  off.closing = {3.5, 3.5};
  off.opening = {-4.5, -4.5};
  const LawError error = law_error(curve_along(flat), off);
  EXPECT_NEAR(error.jnd_n, 0.07 * std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(error.rmse_jnd, 0.5 / (0.07 * std::sqrt(12.5)), 1e-12);
  EXPECT_TRUE(error.worst_is_closing) << "the first of two that are alike";
  EXPECT_NEAR(error.worst_jnd, 0.5 / (0.07 * 3.0), 1e-9);
}

TEST(LawError, OfOneBranchIsThatOfTheClosing) {
  Knots one = loop_of_four();
  one.opening.clear();
  EXPECT_LT(law_error(curve_along(loop_of_four()), one).rmse_n, 1e-14);
}

TEST(LawError, LeavesOutWhereNoCycleReached) {
  EditorCurve curve = curve_along(loop_of_four());
  Knots raised = loop_of_four();
  for (double& force : raised.closing) force += 1.0;
  for (std::size_t i = 0; i < curve.closing.size(); ++i) {
    if (i != 7) curve.closing[i] = nothing;
  }
  EXPECT_NEAR(law_error(curve, raised).rmse_n, 1.0 / std::sqrt(102.0), 1e-12);
  curve.closing.assign(curve.closing.size(), nothing);
  curve.opening = curve.closing;
  EXPECT_THROW((void)law_error(curve, raised), std::invalid_argument);
}

TEST(LawError, GoesOnBeyondTheBreakpointsAsTheRenderedLawDoes) {
  const Knots inside{.penetration = {0.005, 0.01}, .closing = {1.0, 2.0}, .opening = {}};
  const Knots rendered{.penetration = {0.0, 0.005, 0.02}, .closing = {1.0, 1.0, 4.0}, .opening = {}};
  EXPECT_LT(law_error(curve_along(rendered), inside).rmse_n, 1e-14);
}

TEST(LawError, IsThatOfTheTableThatThePageIsHeldToToo) {
  const auto near = [](double value) { return DoubleNear(value, 1e-9 * std::abs(value)); };
  const auto cases = nlohmann::json::parse(
      std::ifstream(std::filesystem::path(KERF_SOURCE_DIR) / "tests/bench/studio/editor/editor_errors.json"));
  ASSERT_GE(cases.size(), 5U);
  for (const auto& one : cases) {
    const auto& of = one["curve"];
    const auto forces = [&](const char* branch) {
      std::vector<double> all;
      for (const auto& force : of[branch]) all.push_back(force.is_null() ? nothing : force.get<double>());
      return all;
    };
    EditorCurve curve{
        .penetration = of["penetration"], .closing = forces("closing"), .opening = forces("opening")};
    curve.jnd = {.weber_fraction = of["jnd"]["weber_fraction"], .threshold = of["jnd"]["threshold_n"]};
    const LawError error = law_error(curve, knots_in(one, "knots"));
    const auto& expected = one["error"];
    EXPECT_THAT(error.rmse_n, near(expected["rmse_n"])) << one["name"];
    EXPECT_THAT(error.worst_n, near(expected["worst_n"])) << one["name"];
    EXPECT_EQ(error.worst_penetration, expected["worst_penetration"].get<double>()) << one["name"];
    EXPECT_EQ(error.worst_is_closing, expected["worst_branch"] == "closing") << one["name"];
    EXPECT_THAT(error.jnd_n, near(expected["jnd_n"])) << one["name"];
    EXPECT_THAT(error.rmse_jnd, near(expected["rmse_jnd"])) << one["name"];
    EXPECT_THAT(error.worst_jnd, near(expected["worst_jnd"])) << one["name"];
  }
}

TEST(BestKnots, FindTheBreaksOfACurveThatHasThem) {
  const EditorCurve curve = curve_along(loop_of_four());
  const Knots best = best_knots(curve, 3, true);
  EXPECT_THAT(best.penetration, Pointwise(DoubleNear(1e-8), loop_of_four().penetration));
  EXPECT_THAT(best.closing, Pointwise(DoubleNear(1e-5), loop_of_four().closing));
  EXPECT_THAT(best.opening, Pointwise(DoubleNear(1e-5), loop_of_four().opening));
  EXPECT_LT(law_error(curve, best).rmse_n, 1e-6);
}

TEST(BestKnots, LeaveTheErrorThatTheFitSays) {
  EditorCurve curve = curve_along(loop_of_four());
  for (std::size_t i = 0; i < curve.closing.size(); ++i)
    curve.closing[i] += 0.3 * std::sin(0.4 * static_cast<double>(i));
  const auto fitted = fitting::fit_segments(
      {.position = curve.penetration, .force = curve.closing, .weight = {}, .branch = {}},
      {.max_segments = 4});
  EXPECT_NEAR(law_error(curve, best_knots(curve, 4, false)).rmse_n, fitted.back().rmse,
              1e-9 * fitted.back().rmse);
}

TEST(BestKnots, AreRefusedWhereThePointsDoNotCarryThem) {
  EditorCurve curve = curve_along(loop_of_four(), 9);
  EXPECT_THAT([&] { (void)best_knots(curve, 8, true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("too few points for 8 segments")));
  EXPECT_THAT([&] { (void)best_knots(curve, 17, true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("1 to 16 segments")));
  curve.opening.assign(curve.opening.size(), nothing);
  EXPECT_THAT([&] { (void)best_knots(curve, 1, true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no opening")));
}

TEST(BestForces, AreThoseOfTheCurveAtItsOwnBreaks) {
  Knots drawn = loop_of_four();
  drawn.closing = {0.0, 0.0, 0.0, 0.0};
  drawn.opening = drawn.closing;
  const Knots best = best_forces(curve_along(loop_of_four()), drawn);
  EXPECT_EQ(best.penetration, drawn.penetration);
  EXPECT_THAT(best.closing, Pointwise(DoubleNear(1e-9), loop_of_four().closing));
  EXPECT_THAT(best.opening, Pointwise(DoubleNear(1e-9), loop_of_four().opening));
}

TEST(BestForces, AreBestForEndsInsideAndOutsideOfTheCurveToo) {
  EditorCurve curve = curve_along(loop_of_four());
  for (std::size_t i = 0; i < curve.closing.size(); ++i)
    curve.closing[i] += 0.3 * std::sin(0.4 * static_cast<double>(i));
  for (const auto& places :
       std::vector<std::vector<double>>{{0.003, 0.009, 0.015}, {-0.002, 0.009, 0.03}, {0.003, 0.017}}) {
    const std::vector<double> zero(places.size(), 0.0);
    const Knots best = best_forces(curve, {.penetration = places, .closing = zero, .opening = zero});
    EXPECT_EQ(best.penetration, places);
    const double least = law_error(curve, best).rmse_n;
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (const double step : {-1e-3, 1e-3}) {
        Knots other = best;
        other.closing[i] += step;
        EXPECT_GT(law_error(curve, other).rmse_n, least) << i << " of " << places.size();
        other = best;
        other.opening[i] += step;
        EXPECT_GT(law_error(curve, other).rmse_n, least) << i << " of " << places.size();
      }
    }
  }
}

struct BadKnots {
  const char* name;
  Knots knots;
  const char* says;
};
class CheckKnots : public testing::TestWithParam<BadKnots> {};

TEST_P(CheckKnots, SaysInASentenceWhatIsWrong) {
  EXPECT_THAT([] { check_knots(GetParam().knots); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(GetParam().says)));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, CheckKnots,
    testing::Values(
        BadKnots{"One", {{0.0}, {1.0}, {}}, "2 to 17 breakpoints, and here are 1"},
        BadKnots{"Many", {std::vector<double>(18, 0.0), {}, {}}, "2 to 17 breakpoints, and here are 18"},
        BadKnots{"TooFewForces", {{0.0, 1.0}, {1.0}, {}}, "1 closing forces for 2 breakpoints"},
        BadKnots{"TooManyOpening", {{0.0, 1.0}, {1.0, 2.0}, {1.0, 2.0, 3.0}}, "3 opening forces for 2"},
        BadKnots{
            "NotANumber", {{0.0, 1.0}, {1.0, nothing}, {}}, "closing force of breakpoint 2 is not a number"},
        BadKnots{"NoPlace", {{nothing, 1.0}, {1.0, 1.0}, {}}, "penetration of breakpoint 1 is not a number"},
        BadKnots{"Huge", {{0.0, 1.0}, {1.0, 1.0}, {0.0, -2e6}}, "opening force of breakpoint 2 is -2e+06"},
        BadKnots{"Same", {{0.0, 0.5, 0.5}, {1.0, 1.0, 1.0}, {}}, "breakpoint 3 at 0.5 must be deeper"},
        BadKnots{"Back",
                 {{0.5, 0.2}, {1.0, 1.0}, {}},
                 "breakpoint 2 at 0.2 must be deeper than breakpoint 1 at 0.5"}),
    [](const auto& one) { return one.param.name; });

TEST(CheckKnots, TakesWhatIsRight) { EXPECT_NO_THROW(check_knots(loop_of_four())); }

TEST(KnotsOf, AreOfAPiecewiseLawAlone) {
  const LawFile kelvin{.law = models::Law::make("exponential", std::vector<double>{1.0, 100.0, 0.0}),
                       .contact = {}};
  EXPECT_THAT([&] { (void)knots_of(kelvin); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'exponential'")));
}

}  // namespace
}  // namespace kerf::bench

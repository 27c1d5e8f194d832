#include "studio/segment_editor.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/segmented.h>
#include <kerf/models/piecewise.h>

#include "fits/fit_recording.h"
#include "fits/fit_series.h"
#include "import/import.h"
#include "laws/render.h"
#include "segment/segment.h"
#include "studio/editor_json.h"

namespace kerf::bench {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;
using testing::ThrowsMessage;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double line(const Knots& knots, const std::vector<double>& force, double x) {
  std::size_t i = 0;
  while (i + 2 < knots.penetration.size() && knots.penetration[i + 1] < x) ++i;
  const double share = (x - knots.penetration[i]) / (knots.penetration[i + 1] - knots.penetration[i]);
  return force[i] + share * (force[i + 1] - force[i]);
}

/// 20 mm, closing up to 10 N and opening against 2 N, with its breaks on points of the curve.
Knots loop_of_four() {
  return {.penetration = {0.0, 0.004, 0.012, 0.02},
          .closing = {1.0, 4.0, 3.0, 10.0},
          .opening = {-2.0, -1.0, -1.0, 2.0}};
}

/// The averaged cycle that a law itself would give.
EditorCurve curve_along(const Knots& knots, std::size_t points = 101) {
  EditorCurve curve{.axis = "x_s", .position_unit = "m", .force_unit = "N", .cycles = 8, .contact = {}};
  for (std::size_t i = 0; i < points; ++i) {
    const double x = knots.penetration.back() * static_cast<double>(i) / static_cast<double>(points - 1);
    curve.penetration.push_back(x);
    curve.closing.push_back(line(knots, knots.closing, x));
    curve.opening.push_back(knots.opening.empty() ? nothing : line(knots, knots.opening, x));
  }
  return curve;
}

/// Opened and closed by cosines, with the forces of a law and not a sample's error: 1 kHz, 8 strokes.
schema::Recording recording_along(double direction, double contact, const Knots& knots,
                                  bool measured = true) {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N·m"}};
  for (int row = 0; row < 8000; ++row) {
    const double phase = std::numbers::pi * row / 1000.0;
    const double x = knots.penetration.back() * 0.5 * (1.0 - std::cos(phase));
    const double force = line(knots, row / 1000 % 2 == 0 ? knots.closing : knots.opening, x);
    recording.time.push_back(1e-3 * row);
    recording.tick.push_back(static_cast<std::uint64_t>(row));
    recording.position.push_back(contact + direction * x);
    recording.velocity.push_back(direction * knots.penetration.back() * 0.5 * 1000.0 * std::sin(phase));
    (measured ? recording.force_measured : recording.force_commanded)
        .push_back(measured ? force : -direction * force);
  }
  return recording;
}

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
      std::ifstream(std::filesystem::path(KERF_SOURCE_DIR) / "tests/bench/studio/editor_errors.json"));
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
    curve.jnd = {.weber_fraction = of["jnd"]["weber_fraction"], .threshold_n = of["jnd"]["threshold_n"]};
    const LawError error = law_error(curve, knots_in(one, "knots"));
    const auto expected = one["error"];
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
      {.most_segments = 4});
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

TEST(EditorCurve, RunsIntoTheTissueFromContactWhicheverWayThatIs) {
  for (const double direction : {1.0, -1.0}) {
    schema::Recording recording = recording_along(direction, 0.3, loop_of_four());
    recording.cycles = find_cycles(recording, {});
    const EditorCurve curve = editor_curve(recording, 0);
    EXPECT_FALSE(curve.segmented_here);
    EXPECT_EQ(curve.cycles, 4U);
    EXPECT_EQ(curve.contact.direction, direction);
    EXPECT_NEAR(curve.contact.position, 0.3, 1e-4);
    EXPECT_NEAR(curve.penetration.front(), 0.0, 1e-12);
    EXPECT_NEAR(curve.penetration.back(), 0.02, 2e-4);
    EXPECT_NEAR(curve.closing[60], 3.0, 0.1) << "direction " << direction;
    EXPECT_NEAR(curve.opening[40], -1.0, 0.1) << "direction " << direction;
    EXPECT_LT(law_error(curve, loop_of_four()).rmse_n, 0.2) << "the law that made it";
  }
}

TEST(EditorCurve, FindsTheCyclesItselfWhereThereAreNone) {
  schema::Recording recording = recording_along(-1.0, 0.3, loop_of_four());
  const EditorCurve here = editor_curve(recording, 0);
  EXPECT_TRUE(here.segmented_here);
  recording.cycles = find_cycles(recording, {});
  const EditorCurve stored = editor_curve(recording, 0);
  EXPECT_EQ(here.penetration, stored.penetration);
  EXPECT_EQ(here.closing.at(50), stored.closing.at(50));
  EXPECT_EQ(here.contact.position, stored.contact.position);
}

TEST(EditorCurve, TurnsCommandedForcesIntoResistingOnes) {
  for (const double direction : {1.0, -1.0}) {
    schema::Recording measured = recording_along(direction, 0.3, loop_of_four());
    measured.cycles = find_cycles(measured, {.closing_direction = direction});
    schema::Recording commanded = recording_along(direction, 0.3, loop_of_four(), false);
    commanded.cycles = find_cycles(commanded, {.closing_direction = direction});
    EXPECT_NEAR(editor_curve(commanded, 0).closing.at(50), editor_curve(measured, 0).closing.at(50), 1e-9);
    EXPECT_NEAR(editor_curve(commanded, 0).opening.at(50), editor_curve(measured, 0).opening.at(50), 1e-9);
  }
}

TEST(EditorCurve, ClosesWhereTheContactSaysThatPenetrationGrows) {
  schema::Recording recording = recording_along(1.0, 0.3, loop_of_four());
  recording.axes[0].contact_position = 0.32;
  recording.axes[0].contact_direction = -1.0;
  recording.cycles = find_cycles(recording, {});
  ASSERT_EQ(recording.cycles->closing_direction, 1.0);
  const EditorCurve curve = editor_curve(recording, 0);
  EXPECT_EQ(curve.contact.direction, -1.0);
  EXPECT_NEAR(curve.penetration.front(), 0.0, 2e-4);
  EXPECT_NEAR(curve.closing[60], -1.0, 0.1) << "the strokes that were called opening";
}

TEST(EditorCurve, HasTheThresholdOfATorqueAtItsLever) {
  schema::Recording recording = recording_along(1.0, 0.0, loop_of_four());
  EXPECT_DOUBLE_EQ(editor_curve(recording, 0).jnd.threshold_n, 0.05 * 0.01);
  recording.axes[0].lever = 0.08;
  EXPECT_DOUBLE_EQ(editor_curve(recording, 0).jnd.threshold_n, 0.05 * 0.08);
  recording.axes[0].force_unit = "N";
  EXPECT_DOUBLE_EQ(editor_curve(recording, 0).jnd.threshold_n, 0.05);
}

TEST(DrawnLaw, GivesTheSameForcesWhenItIsReadBack) {
  const schema::Recording recording = recording_along(-1.0, 0.3, loop_of_four());
  const EditorCurve curve = editor_curve(recording, 0);
  const Knots knots{.penetration = {1e-3 / 3.0, 0.0111, 0.02},
                    .closing = {0.1, 2.0 / 7.0, 9.9},
                    .opening = {-1.1, 0.3, 1.7}};
  CurveSource source = curve_source(recording, 0, curve);
  source.recording_sha256 = "ab12";
  const LawFile read = parse_law_file(to_toml(drawn_law(curve, knots, source)), "drawn.law.toml");
  EXPECT_EQ(read.axis, "theta");
  EXPECT_EQ(read.force_unit, "N·m");
  EXPECT_EQ(read.contact.position, curve.contact.position);
  EXPECT_EQ(read.contact.direction, -1.0);
  EXPECT_EQ(read.fit.recording_uuid, recording.header.uuid);
  EXPECT_EQ(read.fit.recording_sha256, "ab12");
  EXPECT_EQ(read.fit.rmse_n, law_error(curve, knots).rmse_n);
  EXPECT_THAT(read.fit.software, testing::StartsWith("kerf "));
  models::Piecewise<double> law{.knots = 3};
  for (std::size_t i = 0; i < 3; ++i) {
    law.knot[i] = knots.penetration[i];
    law.closing[i] = knots.closing[i];
    law.opening[i] = knots.opening[i];
  }
  const models::Law plain = without_rendering_aids(read.law);
  for (const bool closing : {true, false}) {
    for (const double x : curve.penetration) {
      models::Law::State state = plain.initial_state();
      const double force =
          plain.step(state, {.penetration = x, .velocity = closing ? 1.0 : -1.0}, 1e-3).force;
      EXPECT_EQ(force, law.branch_force(closing, x));
    }
  }
  const Knots again = knots_of(read);
  EXPECT_EQ(again.penetration, knots.penetration);
  EXPECT_EQ(again.closing, knots.closing);
  EXPECT_EQ(again.opening, knots.opening);
}

TEST(DrawnLaw, LiesWhereAFitDoesAndHasItsRenderingAids) {
  schema::Recording recording = recording_along(-1.0, 0.3, loop_of_four());
  recording.cycles = find_cycles(recording, {});
  const EditorCurve curve = editor_curve(recording, 0);
  const CurveSource source = curve_source(recording, 0, curve);
  const LawFile both = drawn_law(curve, loop_of_four(), source);
  const FittedLaw fitted =
      fit_recording(
          recording,
          {.models = {"piecewise"}, .segments = 3, .law_options = {"loop=true"}, .fit = {.folds = 0}})
          .laws.at(0);
  EXPECT_EQ(both.law.options(), fitted.file.law.options());
  EXPECT_EQ(both.contact.position, fitted.file.contact.position);
  EXPECT_LT(law_error(curve, knots_of(fitted.file)).rmse_jnd, 1.0) << "of the same forces, with their signs";
  Knots one = loop_of_four();
  one.opening.clear();
  EXPECT_FALSE(drawn_law(curve, one, source).law.options().contains("ramp_band"));
}

/// A punch through a meniscus: its averaged cycle is as the measured one, and takes a fit as `kerf fit` does.
TEST(DrawnLaw, OfAMeniscusIsCloserTheMoreSegmentsItHas) {
  const std::filesystem::path file =
      std::filesystem::path(KERF_SHARED_DATA) / "meniscus/9_meniscus_slow_1824.txt";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no measured data at " << KERF_SHARED_DATA;
  const schema::Recording punch =
      import_text(file, {.map = parse_map("time=5[ms],position=4[deg],force=2[gf]"), .rate_hz = 0.0})
          .recording;
  const EditorCurve curve = editor_curve(punch, 0);
  EXPECT_EQ(curve.cycles, 10U);
  double last = std::numeric_limits<double>::infinity();
  for (const std::size_t segments : {1U, 2U, 4U}) {
    const Knots best = best_knots(curve, segments, true);
    const LawError error = law_error(curve, best);
    EXPECT_LT(error.rmse_n, last) << segments;
    last = error.rmse_n;
    EXPECT_NEAR(law_error(curve, best_forces(curve, best)).rmse_n, error.rmse_n, 1e-6 * error.rmse_n);
    std::vector<double> force;
    std::vector<double> place;
    std::vector<std::uint8_t> branch;
    for (std::size_t i = 0; i < curve.penetration.size(); ++i) {
      for (std::uint8_t of = 0; of < 2; ++of) {
        const double mean = of == 0 ? curve.closing[i] : curve.opening[i];
        if (std::isnan(mean)) continue;
        place.push_back(curve.penetration[i]);
        force.push_back(mean);
        branch.push_back(of);
      }
    }
    const auto fitted = fitting::fit_segments(
        {.position = place, .force = force, .weight = {}, .branch = branch}, {.most_segments = segments});
    EXPECT_NEAR(error.rmse_n, fitted.back().rmse, 1e-9 * fitted.back().rmse) << "as the fit has it";
  }
  EXPECT_LT(last, 0.3) << "of up to 6 N";
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

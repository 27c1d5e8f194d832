#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/segmented.h>
#include <kerf/models/piecewise.h>

#include "bench/studio/editor/editor_curves.h"
#include "editor/segment_editor.h"
#include "fits/fit_recording.h"
#include "import/import.h"
#include "laws/render.h"
#include "segment/segment.h"
#include "support/measured_data.h"

// From a recording to its curve, and from breakpoints to a law.

namespace kerf::bench {
namespace {

using test::line;
using test::loop_of_four;

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
  EXPECT_DOUBLE_EQ(editor_curve(recording, 0).jnd.threshold, 0.05 * 0.01);
  recording.axes[0].lever = 0.08;
  EXPECT_DOUBLE_EQ(editor_curve(recording, 0).jnd.threshold, 0.05 * 0.08);
  recording.axes[0].force_unit = "N";
  EXPECT_DOUBLE_EQ(editor_curve(recording, 0).jnd.threshold, 0.05);
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
  const std::string file = "meniscus/9_meniscus_slow_1824.txt";
  KERF_NEEDS_DATA(file);
  const schema::Recording punch =
      import_text(kerf::test::measured_file(file),
                  {.map = parse_map("time=5[ms],position=4[deg],force=2[gf]"), .rate_hz = 0.0})
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
        {.position = place, .force = force, .weight = {}, .branch = branch}, {.max_segments = segments});
    EXPECT_NEAR(error.rmse_n, fitted.back().rmse, 1e-9 * fitted.back().rmse) << "as the fit has it";
  }
  EXPECT_LT(last, 0.3) << "of up to 6 N";
}

}  // namespace
}  // namespace kerf::bench

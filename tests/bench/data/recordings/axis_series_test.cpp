#include "recordings/axis_series.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

schema::Recording closing_scissors() {
  schema::Recording recording;
  recording.axes = {{.name = "x_s"}, {.name = "theta", .position_unit = "rad"}};
  recording.time = {0.0, 0.5, 1.0};
  recording.position = {0.0, 0.5, 0.0, 0.4, 0.0, 0.2};
  recording.velocity = {0.0, 0.0, 0.0, -0.2, 0.0, -0.4};
  recording.force_measured = {9.0, 0.0, 9.0, 1.0, 9.0, 3.0};
  return recording;
}

const models::Contact half_open{.position = 0.5, .direction = -1.0};

TEST(AxisSeries, IsSeenInTheDirectionOfEngagement) {
  const AxisSeries series = axis_series(closing_scissors(), 1, half_open);
  EXPECT_THAT(series.penetration, ElementsAre(0.0, DoubleEq(0.1), DoubleEq(0.3)));
  EXPECT_THAT(series.velocity, ElementsAre(0.0, 0.2, 0.4));
  EXPECT_THAT(series.force, ElementsAre(0.0, 1.0, 3.0));
  EXPECT_TRUE(series.cycle.empty());
}

TEST(AxisSeries, RefusesPhasesOfRowsThatAreNotThere) {
  schema::Recording recording = closing_scissors();
  recording.cycles = schema::Cycles{.axis = 1};
  recording.cycles->phases = {{.cycle = 1, .phase = schema::Phase::closing, .begin = 1, .end = 4}};
  EXPECT_THROW((void)axis_series(recording, 1, half_open), schema::FormatError);
  recording.cycles->phases[0] = {.cycle = 1, .phase = schema::Phase::closing, .begin = 3, .end = 1};
  EXPECT_THROW((void)axis_series(recording, 1, half_open), schema::FormatError);
}

TEST(AxisSeries, TurnsACommandIntoTheResistanceThatItRenders) {
  schema::Recording recording = closing_scissors();
  recording.force_commanded = recording.force_measured;
  recording.force_measured.clear();
  EXPECT_THAT(axis_series(recording, 1, half_open).force, ElementsAre(0.0, 1.0, 3.0))
      << "closing shrinks the angle, so a command that opens resists";
  EXPECT_THAT(axis_series(recording, 1, {}).force, ElementsAre(0.0, -1.0, -3.0));
}

TEST(AxisSeries, KnowsTheCycleOfEachRow) {
  schema::Recording recording = closing_scissors();
  recording.cycles = schema::Cycles{.axis = 1, .closing_direction = -1.0, .contact_position = 0.5};
  recording.cycles->phases = {{.cycle = 1, .phase = schema::Phase::closing, .begin = 1, .end = 3}};
  EXPECT_THAT(axis_series(recording, 1, half_open).cycle, ElementsAre(0U, 1U, 1U));
  recording.cycles->axis = 0;
  EXPECT_TRUE(axis_series(recording, 1, half_open).cycle.empty()) << "cycles of another axis";
}

TEST(AxisSeries, RefusesARecordingWithoutForce) {
  schema::Recording recording = closing_scissors();
  recording.force_measured.clear();
  EXPECT_THROW((void)axis_series(recording, 1, half_open), std::invalid_argument);
  EXPECT_THROW((void)axis_series(closing_scissors(), 2, half_open), std::invalid_argument);
}

TEST(FitSeries, LeavesOutRowsThatAreNotFiniteAndCountsThem) {
  schema::Recording recording = closing_scissors();
  recording.force_measured[3] = std::nan("");
  const AxisSeries series = fit_series(recording, 1, half_open);
  EXPECT_THAT(series.time_s, ElementsAre(0.0, 1.0));
  EXPECT_THAT(series.force, ElementsAre(0.0, 3.0));
  EXPECT_EQ(series.left_out, 1U);
}

TEST(FitSeries, ArePooledOneAfterTheOther) {
  const AxisSeries one = fit_series(closing_scissors(), 1, half_open);
  EXPECT_THAT(pooled({one, one}).force, ElementsAre(0.0, 1.0, 3.0, 0.0, 1.0, 3.0));
}

}  // namespace
}  // namespace kerf::bench

#include "laws/render.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

schema::Recording closing_scissors() {
  schema::Recording recording;
  recording.axes = {{.name = "x_s"}, {.name = "theta", .position_unit = "rad"}};
  recording.time = {0.0, 0.5, 1.0};
  recording.position = {0.0, 0.5, 0.0, 0.4, 0.0, 0.2};
  recording.velocity = {0.0, 0.0, 0.0, -0.2, 0.0, -0.4};
  recording.force_measured = {9.0, 0.0, 9.0, 1.0, 9.0, 3.0};
  return recording;
}

TEST(Contact, ComesFromTheSceneOrTheCyclesOrTheLeastPosition) {
  schema::Recording recording = closing_scissors();
  EXPECT_EQ(contact_of(recording, 1).position, 0.2);
  EXPECT_EQ(contact_of(recording, 1).direction, 1.0);
  recording.cycles = schema::Cycles{.axis = 1, .closing_direction = -1.0, .contact_position = 0.5};
  EXPECT_EQ(contact_of(recording, 1).position, 0.5);
  EXPECT_EQ(contact_of(recording, 1).direction, -1.0);
  recording.header.scene_toml = R"(name = "cut"
[tissue]
model = "exponential"
axis = "theta"
position_unit = "rad"
contact = { position = { value = 0.45, unit = "rad" }, direction = "decreasing" }
parameters = { amplitude = { value = 0.1, unit = "N" }, exponent = { value = 1, unit = "1" }, viscosity = { value = 0.0, unit = "N·s/rad" } }
)";
  EXPECT_EQ(contact_of(recording, 1).position, 0.45);
}

TEST(Render, GivesWhatTheLawGivesTickByTick) {
  const auto law = models::Law::make("kelvin", std::vector{8.0, 7.0, 130.0});
  AxisSeries ramp;
  for (int i = 0; i <= 2500; ++i) {
    ramp.time_s.push_back(1e-3 * i);
    ramp.penetration.push_back(2e-6 * i);
    ramp.velocity.push_back(2e-3);
  }
  const auto force = render(law, ramp);
  ASSERT_EQ(force.size(), 2501U);
  EXPECT_EQ(force.front(), 0.0);
  EXPECT_NEAR(force.back() / 0.0727464745656, 1.0, 1e-10);
}

TEST(Render, CommandsOnTheAxisOfTheDeviceWhatResists) {
  // A spring of 10 N/rad between blades that close below 0.5 rad, beside a damper that nothing moves.
  const LawFile law{.law = models::Law::make("kelvin", std::vector{10.0, 1.0, 1.0}),
                    .contact = {.position = 0.5, .direction = -1.0}};
  SampledMotion motion = ticks_at(500.0, 3);
  motion.sample[2].position[1] = motion.sample[1].position[1] = 0.2;
  motion.sample[0].position[1] = 0.6;
  const RenderedMotion rendered = render(law, {1}, motion);
  ASSERT_EQ(rendered.force.size(), 3U);
  EXPECT_EQ(rendered.force[0][1], 0.0) << "open";
  EXPECT_GE(rendered.force[2][1], 3.0) << "0.3 rad deep; it opens the blades";
  EXPECT_EQ(rendered.force[2][0], 0.0);
  EXPECT_EQ(rendered.faults, 0U);
}

TEST(Render, CountsTheTicksInWhichALawFails) {
  const LawFile law{.law = models::Law::make("kelvin", std::vector{10.0, 1.0, 1.0})};
  SampledMotion motion = ticks_at(1000.0, 5);
  motion.sample[2].position[0] = motion.sample[4].velocity[0] = std::nan("");
  const RenderedMotion rendered = render(law, {0}, motion);
  EXPECT_EQ(rendered.faults, 2U);
  EXPECT_EQ(rendered.first_fault, 2U);
}

TEST(Deepest, IsHowFarAMotionGoesIntoTheTissue) {
  SampledMotion motion = ticks_at(1000.0, 3);
  motion.sample[1].position[2] = -0.3;
  EXPECT_EQ(deepest(motion, 2, {.position = -0.1, .direction = -1.0}), 0.3 - 0.1);
  EXPECT_EQ(deepest(motion, 2, {.position = 0.1, .direction = 1.0}), 0.0) << "it never gets there";
}

TEST(Periods, OfTheFirstSampleIsThatOfTheNext) {
  EXPECT_EQ(periods_of(std::vector{1.0, 1.5, 1.75}), (std::vector{0.5, 0.5, 0.25}));
  EXPECT_EQ(periods_of(std::vector{1.0}), std::vector{1e-3});
}

}  // namespace
}  // namespace kerf::bench

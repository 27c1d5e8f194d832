#include "scene/motion.h"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

#include "support/example_laws.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const LawFile kelvin{.law = test::example("kelvin"), .axis = "theta", .position_unit = "rad"};

SampledMotion scripted(ScriptedAxis motion, double seconds = 1.0) {
  return sampled({.axes = {motion}, .seconds = seconds}, kelvin);
}

const std::vector<ScriptedAxis> every_kind{
    {.script = Rest{.at = 0.3}},
    {.script = StrokesToAndFro{.from = 0.6, .to = 0.1, .stroke_s = 0.2, .pause_s = 0.05}},
    {.script = Sine{.centre = 0.3, .amplitude = 0.2, .frequency_hz = 3.0, .phase_rad = 0.4}},
    {.script = RampAndHold{.from = 0.6, .to = 0.1, .start_s = 0.1, .ramp_s = 0.2, .hold_s = 0.3}}};

TEST(ScriptedMotion, HasOneEntryATick) {
  const SampledMotion path = scripted(every_kind[0], 0.75);
  EXPECT_EQ(path.ticks(), 750U);
  EXPECT_DOUBLE_EQ(path.time_s.back(), 0.749);
  EXPECT_EQ(path.period_s[7], 1e-3);
}

TEST(ScriptedMotion, MovesAtTheSpeedThatItSays) {
  for (const ScriptedAxis& motion : every_kind) {
    const SampledMotion path = scripted(motion);
    double travelled = 0.0;
    double most = 0.0;
    for (std::size_t i = 1; i < path.ticks(); ++i) {
      travelled += 0.5e-3 * (path.sample[i - 1].velocity[0] + path.sample[i].velocity[0]);
      most = std::max(most, std::abs(path.sample[0].position[0] + travelled - path.sample[i].position[0]));
    }
    EXPECT_LT(most, 3e-3) << motion.script.index();
  }
}

TEST(ScriptedMotion, GoesToAndFroBetweenItsEnds) {
  const SampledMotion path = scripted(every_kind[1]);
  EXPECT_EQ(path.sample[0].position[0], 0.6);
  EXPECT_EQ(path.sample[50].velocity[0], 0.0) << "it pauses first";
  EXPECT_DOUBLE_EQ(path.sample[150].position[0], 0.35) << "half way";
  EXPECT_NEAR(path.sample[150].velocity[0], -1.875 * 0.5 / 0.2, 1e-9) << "15/8 of the mean speed";
  EXPECT_NEAR(path.sample[275].position[0], 0.1, 1e-12);
  EXPECT_NEAR(path.sample[500].position[0], 0.6, 1e-9);
}

TEST(ScriptedMotion, HoldsAfterItsRampAndComesBack) {
  const SampledMotion path = scripted(every_kind[3]);
  EXPECT_NEAR(path.sample[200].position[0], 0.35, 1e-12);
  EXPECT_DOUBLE_EQ(path.sample[200].velocity[0], -2.5);
  EXPECT_EQ(path.sample[450].position[0], 0.1);
  EXPECT_DOUBLE_EQ(path.sample[700].velocity[0], 2.5);
  EXPECT_EQ(path.sample[900].position[0], 0.6);
}

class RecordedMotion : public testing::Test {
 protected:
  MotionSource along(const schema::Recording& recording) const {
    schema::write_recording(folder_ / "r.h5", recording);
    return {.recording = folder_ / "r.h5"};
  }
  static schema::Recording closing() {
    schema::Recording recording;
    recording.header = schema::new_header("test");
    recording.axes = {{.name = "x_s"}, {.name = "theta", .position_unit = "rad"}};
    for (int i = 0; i < 100; ++i) {
      recording.time.push_back(5.0 + 2e-3 * i);
      recording.tick.push_back(static_cast<std::uint64_t>(i));
      recording.position.insert(recording.position.end(), {7.0, 0.6 - 1e-3 * i});
      recording.velocity.insert(recording.velocity.end(), {0.0, -0.5});
    }
    return recording;
  }
  test::TemporaryFolder folder_;
};

TEST_F(RecordedMotion, TakesTheLawsAxisRowByRow) {
  const SampledMotion path = sampled(along(closing()), kelvin);
  ASSERT_EQ(path.ticks(), 100U);
  EXPECT_DOUBLE_EQ(path.sample[50].position[0], 0.55);
  EXPECT_NEAR(path.period_s[0], 2e-3, 1e-12);
}

TEST_F(RecordedMotion, StopsAfterTheSecondsAskedFor) {
  MotionSource source = along(closing());
  source.seconds = 0.1;
  EXPECT_EQ(sampled(source, kelvin).ticks(), 50U);
}

TEST_F(RecordedMotion, RefusesWhatALawCannotFollow) {
  schema::Recording broken = closing();
  broken.position[2 * 40 + 1] = std::nan("");
  EXPECT_THAT([&] { (void)sampled(along(broken), kelvin); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("row 40 of axis 'theta' is not finite")));
  schema::Recording other = closing();
  other.axes[1].name = "z";
  EXPECT_THAT([&] { (void)sampled(along(other), kelvin); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("the recording has no axis 'theta'")));
  other.axes[1] = {.name = "theta", .position_unit = "m"};
  EXPECT_THAT([&] { (void)sampled(along(other), kelvin); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("axis 'theta' is in m, and the law's in rad")));
}

}  // namespace
}  // namespace kerf::bench

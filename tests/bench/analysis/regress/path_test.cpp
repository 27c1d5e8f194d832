#include "regress/path.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regress/forces.h"
#include "support/example_laws.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

RegressionCase case_with(ScriptedAxis motion, double seconds = 1.0) {
  return {.name = "one",
          .law = {.law = test::example("kelvin"), .axis = "theta", .position_unit = "rad"},
          .motion = {motion},
          .seconds = seconds};
}

const std::vector<ScriptedAxis> every_kind{
    {.script = Rest{.at = 0.3}},
    {.script = StrokesToAndFro{.from = 0.6, .to = 0.1, .stroke_s = 0.2, .pause_s = 0.05}},
    {.script = Sine{.centre = 0.3, .amplitude = 0.2, .frequency_hz = 3.0, .phase_rad = 0.4}},
    {.script = RampAndHold{.from = 0.6, .to = 0.1, .start_s = 0.1, .ramp_s = 0.2, .hold_s = 0.3}}};

TEST(RegressionPath, HasOneEntryATick) {
  const SampledMotion path = path_of(case_with(every_kind[0], 0.75));
  EXPECT_EQ(path.ticks(), 750U);
  EXPECT_DOUBLE_EQ(path.time_s.back(), 0.749);
  EXPECT_EQ(path.period_s[7], 1e-3);
}

TEST(RegressionPath, MovesAtTheSpeedThatItSays) {
  for (const ScriptedAxis& motion : every_kind) {
    const SampledMotion path = path_of(case_with(motion));
    double travelled = 0.0;
    double most = 0.0;
    for (std::size_t i = 1; i < path.ticks(); ++i) {
      travelled += 0.5e-3 * (path.sample[i - 1].velocity[0] + path.sample[i].velocity[0]);
      most = std::max(most, std::abs(path.sample[0].position[0] + travelled - path.sample[i].position[0]));
    }
    EXPECT_LT(most, 3e-3) << motion.script.index();
  }
}

TEST(RegressionPath, GoesToAndFroBetweenItsEnds) {
  const SampledMotion path = path_of(case_with(every_kind[1]));
  EXPECT_EQ(path.sample[0].position[0], 0.6);
  EXPECT_EQ(path.sample[50].velocity[0], 0.0) << "it pauses first";
  EXPECT_DOUBLE_EQ(path.sample[150].position[0], 0.35) << "half way";
  EXPECT_NEAR(path.sample[150].velocity[0], -1.875 * 0.5 / 0.2, 1e-9) << "15/8 of the mean speed";
  EXPECT_NEAR(path.sample[275].position[0], 0.1, 1e-12);
  EXPECT_NEAR(path.sample[500].position[0], 0.6, 1e-9);
}

TEST(RegressionPath, HoldsAfterItsRampAndComesBack) {
  const SampledMotion path = path_of(case_with(every_kind[3]));
  EXPECT_NEAR(path.sample[200].position[0], 0.35, 1e-12);
  EXPECT_DOUBLE_EQ(path.sample[200].velocity[0], -2.5);
  EXPECT_EQ(path.sample[450].position[0], 0.1);
  EXPECT_DOUBLE_EQ(path.sample[700].velocity[0], 2.5);
  EXPECT_EQ(path.sample[900].position[0], 0.6);
}

class RecordedPath : public testing::Test {
 protected:
  RegressionCase along(const schema::Recording& recording) const {
    schema::write_recording(folder_ / "r.h5", recording);
    return {.name = "one",
            .law = {.law = test::example("kelvin"), .axis = "theta", .position_unit = "rad"},
            .recording = folder_ / "r.h5"};
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

TEST_F(RecordedPath, TakesTheLawsAxisRowByRow) {
  const SampledMotion path = path_of(along(closing()));
  ASSERT_EQ(path.ticks(), 100U);
  EXPECT_DOUBLE_EQ(path.sample[50].position[0], 0.55);
  EXPECT_NEAR(path.period_s[0], 2e-3, 1e-12);
}

TEST_F(RecordedPath, StopsAfterTheSecondsAskedFor) {
  RegressionCase one = along(closing());
  one.seconds = 0.1;
  EXPECT_EQ(path_of(one).ticks(), 50U);
}

TEST_F(RecordedPath, RefusesWhatALawCannotFollow) {
  schema::Recording broken = closing();
  broken.position[2 * 40 + 1] = std::nan("");
  EXPECT_THAT([&] { (void)path_of(along(broken)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("row 40 of axis 'theta' is not finite")));
  schema::Recording other = closing();
  other.axes[1].name = "z";
  EXPECT_THAT([&] { (void)path_of(along(other)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("the recording has no axis 'theta'")));
  other.axes[1] = {.name = "theta", .position_unit = "m"};
  EXPECT_THAT([&] { (void)path_of(along(other)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("axis 'theta' is in m, and the law's in rad")));
}

TEST(Checksum, ChangesWithAnyDigitOfThePath) {
  SampledMotion path = path_of(case_with(every_kind[1]));
  const std::string before = checksum(path, 1);
  EXPECT_EQ(before, checksum(path_of(case_with(every_kind[1])), 1));
  path.sample[3].velocity[0] = std::nextafter(path.sample[3].velocity[0], 1.0);
  EXPECT_NE(checksum(path, 1), before);
}

TEST(Checksum, OfALawIsOfWhatBearsOnItsForces) {
  LawFile law{.law = test::example("kelvin")};
  const std::string before = checksum(law);
  law.std_errors = {1.0, 1.0, 1.0};
  law.fit.recording_uuid = "abc";
  EXPECT_EQ(checksum(law), before);
  law.contact.position = 1e-9;
  EXPECT_NE(checksum(law), before);
}

TEST(RenderedForcesOf, EveryLawAreTheSameTwice) {
  for (const models::LawInfo& info : models::registry()) {
    RegressionCase one = case_with(every_kind[1], 0.1);
    one.law.law = test::example(info.name);
    const SampledMotion path = path_of(one);
    const RenderedForces first = render_forces(one.law, path);
    EXPECT_EQ(first.rows(), 100U) << info.name;
    EXPECT_EQ(first.force, render_forces(one.law, path).force) << info.name;
  }
}

TEST(RenderedForcesOf, AFaultAreCounted) {
  const RegressionCase one = case_with(every_kind[1], 0.1);
  SampledMotion path = path_of(one);
  path.sample[30].position[0] = std::nan("");
  const RenderedForces got = render_forces(one.law, path);
  EXPECT_EQ(got.faults, 1U);
  EXPECT_EQ(got.first_fault, 30U);
}

TEST(TickCost, IsManyTimesHigherForAMesh) {
  const RegressionCase spring = case_with(every_kind[1], 0.2);
  RegressionCase mesh = spring;
  mesh.law.law = test::example("scissors_mesh");
  const double simple = tick_cost(spring.law, path_of(spring));
  EXPECT_GT(simple, 0.0);
  EXPECT_GT(tick_cost(mesh.law, path_of(mesh)), 5.0 * simple);
}

}  // namespace
}  // namespace kerf::bench

#include "regress/path.h"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regress/forces.h"
#include "support/example_laws.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

RegressionCase case_with(ScriptedAxis motion, double seconds = 1.0) {
  return {.name = "one",
          .law = {.law = test::example("kelvin"), .axis = "theta", .position_unit = "rad"},
          .motion = {.axes = {motion}, .seconds = seconds}};
}

const ScriptedAxis strokes{.script =
                               StrokesToAndFro{.from = 0.6, .to = 0.1, .stroke_s = 0.2, .pause_s = 0.05}};

TEST(RegressionPath, IsRefusedUnderTheNameOfItsCase) {
  RegressionCase one = case_with(strokes);
  one.motion.seconds = 1e-6;
  EXPECT_THAT([&] { (void)path_of(one); },
              testing::ThrowsMessage<std::invalid_argument>("case 'one': its trajectory has no tick"));
}

TEST(Checksum, ChangesWithAnyDigitOfThePath) {
  SampledMotion path = path_of(case_with(strokes));
  const std::string before = checksum(path, 1);
  EXPECT_EQ(before, checksum(path_of(case_with(strokes)), 1));
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
    RegressionCase one = case_with(strokes, 0.1);
    one.law.law = test::example(info.name);
    const SampledMotion path = path_of(one);
    const RenderedForces first = render_forces(one.law, path);
    EXPECT_EQ(first.rows(), 100U) << info.name;
    EXPECT_EQ(first.force, render_forces(one.law, path).force) << info.name;
  }
}

TEST(RenderedForcesOf, AFaultAreCounted) {
  const RegressionCase one = case_with(strokes, 0.1);
  SampledMotion path = path_of(one);
  path.sample[30].position[0] = std::nan("");
  const RenderedForces got = render_forces(one.law, path);
  EXPECT_EQ(got.faults, 1U);
  EXPECT_EQ(got.first_fault, 30U);
}

TEST(TickCost, IsManyTimesHigherForAMesh) {
  const RegressionCase spring = case_with(strokes, 0.2);
  RegressionCase mesh = spring;
  mesh.law.law = test::example("scissors_mesh");
  const double simple = tick_cost(spring.law, path_of(spring));
  EXPECT_GT(simple, 0.0);
  EXPECT_GT(tick_cost(mesh.law, path_of(mesh)), 5.0 * simple);
}

}  // namespace
}  // namespace kerf::bench

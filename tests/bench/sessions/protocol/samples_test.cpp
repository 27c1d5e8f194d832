#include "protocol/samples.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/hand.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "laws/placement.h"
#include "loop/command.h"
#include "scene/scene.h"

namespace kerf::bench {
namespace {

using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double as_it_is = std::numeric_limits<double>::quiet_NaN();
constexpr auto strokes = R"([motion]
from = { value = 0.55, unit = "rad" }
to = { value = 0.2, unit = "rad" }
stroke = { value = 200, unit = "ms" }
pause = { value = 50, unit = "ms" }
seconds = { value = 500, unit = "ms" }
)";

double peak_of(const std::vector<double>& forces) {
  double peak = 0.0;
  for (const double force : forces) peak = std::max(peak, std::abs(force));
  return peak;
}
double rms_of(const std::vector<double>& forces) {
  double sum = 0.0;
  for (const double force : forces) sum += force * force;
  return std::sqrt(sum / static_cast<double>(forces.size()));
}
std::vector<double> forces_of(const Protocol& protocol, std::size_t sample, double level = as_it_is) {
  return forces_along(protocol, played(protocol, sample, level));
}

TEST(PlayedSample, HasTheNamedParametersTimesOneMoreThanTheLevel) {
  const Protocol protocol = protocol_from(
      level_text("design = \"constant\"", "vary = [\"parallel_stiffness\", \"damping\"]\nlevels = [0.25]"));
  EXPECT_THAT(played(protocol, 0, 0.25).law.law.values(), ElementsAre(2.5, 7.0, 2.5));
  EXPECT_THAT(played(protocol, 0, as_it_is).law.law.values(), ElementsAre(2.0, 7.0, 2.0));
  EXPECT_EQ(played(protocol, 0, 0.25).gain, 1.0);
}

TEST(PlayedSample, HasItsWholeForceTimesOneMoreThanTheLevel) {
  Protocol protocol = protocol_from(level_text("design = \"constant\"", "vary = \"force\"\nlevels = [0.25]"));
  protocol.samples[0].gain = 2.0;
  EXPECT_EQ(played(protocol, 0, 0.25).gain, 2.5);
  EXPECT_THAT(played(protocol, 0, 0.25).law.law.values(), ElementsAre(2.0, 7.0, 2.0));
  EXPECT_EQ(played(protocol, 0, as_it_is).gain, 2.0);
}

TEST(PlayedSample, VariesEveryValueOfAParameterThatHasMany) {
  const Protocol protocol = test::example_protocol("staircase");
  const models::Law& law = protocol.samples[0].law.law;
  EXPECT_THAT(parameters_named(law, "closing"), ElementsAre(3, 4, 5));
  EXPECT_THAT(parameters_named(law, "closing[1]"), ElementsAre(4));
  EXPECT_THAT(parameters_named(law, "clos"), SizeIs(0));
}

TEST(PlayedSample, RefusesALevelThatItsLawDoesNotHave) {
  const Protocol protocol =
      protocol_from(level_text("design = \"constant\"", "vary = [\"order\"]\nlevels = [0.5]", "tight"));
  EXPECT_THAT([&] { (void)played(protocol, 0, 1.5); },
              ThrowsMessage<std::invalid_argument>(testing::AllOf(
                  HasSubstr("sample 'tight' cannot be played at level 1.5"), HasSubstr("order"))));
}

TEST(PlayedSample, OfATrialIsTheStandardAndTheComparison) {
  const Protocol protocol =
      protocol_from(level_text("design = \"constant\"", "vary = \"force\"\nlevels = [0.25]"));
  const auto both = played(protocol, TrialPlan{.pair = {0, 0}, .level = 0.25});
  ASSERT_THAT(both, SizeIs(2));
  EXPECT_EQ(both[0].gain, 1.0);
  EXPECT_EQ(both[1].gain, 1.25);
}

TEST(SampleForces, AreThoseThatTheLoopRenders) {
  const Protocol protocol = protocol_from(protocol_text("design = \"abx\"", strokes));
  const LawFile& law = protocol.samples[1].law;
  LawRendering loop(law.law, law.contact, {0});
  const std::vector<double> forces = forces_of(protocol, 1);
  ASSERT_THAT(forces, SizeIs(500));
  for (std::size_t tick = 0; tick < forces.size(); ++tick) {
    const double half = 0.25;
    const double time_s = 1e-3 * static_cast<double>(tick);
    const bool back = time_s >= half;
    const double t = (back ? time_s - half : time_s) - 0.05;
    const drivers::MinimumJerk progress = drivers::MinimumJerk::at(std::clamp(t / 0.2, 0.0, 1.0));
    drivers::Sample sample;
    const double from = back ? 0.2 : 0.55;
    const double to = back ? 0.55 : 0.2;
    sample.position[0] = from + (to - from) * progress.position;
    sample.velocity[0] = t > 0.0 ? (to - from) * progress.speed / 0.2 : 0.0;
    EXPECT_NEAR(forces[tick], loop(sample, 1e-3).force[0], 1e-9) << tick;
  }
}

TEST(SampleForces, PushTheToolOutAndGrowWithTheGain) {
  const Protocol protocol = protocol_from(protocol_text("design = \"abx\"", strokes));
  PlayedLaw law = played(protocol, 1, as_it_is);
  const std::vector<double> once = forces_along(protocol, law);
  law.gain = 2.0;
  const std::vector<double> twice = forces_along(protocol, law);
  EXPECT_EQ(once.front(), 0.0) << "before the contact";
  // 0.3 rad deep: the parallel spring of 8 N/rad alone gives 2.4 N, in the sense that opens the scissors.
  EXPECT_GT(once[249], 2.4);
  for (std::size_t tick = 0; tick < once.size(); ++tick) EXPECT_EQ(twice[tick], 2.0 * once[tick]);
}

TEST(SampleForces, OfASpatialLawFollowAScene) {
  Protocol protocol = protocol_from(protocol_text("design = \"abx\""));
  const auto examples = std::filesystem::path(KERF_SOURCE_DIR) / "examples";
  protocol.samples[0].law = read_law_file(examples / "fuzzy_kelvin_3d.law.toml");
  protocol.motion = MotionSource{.scene = examples / "scenes" / "palpation.scene.toml", .seconds = 2.0};
  const std::vector<double> forces = forces_of(protocol, 0);
  const Scene scene = read_scene(protocol.motion->scene);
  const SampledMotion path = tool_path(scene, 1000.0);
  const LawFile& law = protocol.samples[0].law;
  const std::size_t axes = law.law.axes().size();
  const auto device = drivers::open_device(device_of(scene))->info();
  const std::vector<std::size_t> places = axes_for(law, device);
  LawRendering loop(law.law, law.contact, places);
  ASSERT_THAT(forces, SizeIs(2000 * axes));
  for (std::size_t tick = 0; tick < 2000; ++tick) {
    const Command command = loop(path.sample[tick], 1e-3);
    for (std::size_t axis = 0; axis < axes; ++axis)
      ASSERT_EQ(forces[tick * axes + axis], command.force[places[axis]]) << tick;
  }
  EXPECT_GT(peak_of(forces), 0.0);
}

TEST(SampleForces, NeedAMotion) {
  const Protocol protocol = protocol_from(protocol_text("design = \"abx\""));
  EXPECT_THAT([&] { (void)forces_of(protocol, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("has no [motion]")));
}

TEST(Loudness, MakesTheRootMeanSquareThatOfTheFirst) {
  Protocol protocol = protocol_from(protocol_text("design = \"abx\"\nloudness = \"rms\"", strokes));
  const double wanted = rms_of(forces_of(protocol, 0));
  EXPECT_LT(wanted, 0.8 * rms_of(forces_of(protocol, 1)));
  match_loudness(protocol);
  EXPECT_EQ(protocol.samples[0].gain, 1.0);
  EXPECT_NEAR(rms_of(forces_of(protocol, 1)), wanted, 1e-12);
}

TEST(Loudness, MakesThePeakThatOfTheFirstOfTheTissue) {
  Protocol protocol = protocol_from(
      protocol_text("design = \"abx\"\nloudness = \"peak\"",
                    fmt::format("[[tissue]]\nname = \"t\"\nsamples = [\"stiff\", \"soft\"]\n{}", strokes)));
  const double wanted = peak_of(forces_of(protocol, 1));
  match_loudness(protocol);
  EXPECT_EQ(protocol.samples[1].gain, 1.0);
  EXPECT_NEAR(peak_of(forces_of(protocol, 0)), wanted, 1e-12);
}

TEST(Loudness, LeavesSamplesAsTheyAreWhereNothingIsAsked) {
  Protocol protocol = protocol_from(protocol_text("design = \"abx\"", strokes));
  match_loudness(protocol);
  EXPECT_EQ(protocol.samples[1].gain, 1.0);
}

TEST(Loudness, RefusesASampleThatWouldNeedTwoGains) {
  Protocol protocol = protocol_from(
      protocol_text("design = \"abx\"\nloudness = \"rms\"", fmt::format("{}{}", test::two_tissues, strokes)));
  EXPECT_THAT([&] { match_loudness(protocol); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("of its own")));
  EXPECT_EQ(protocol.samples[1].gain, 1.0) << "nothing is half done";
}

TEST(Loudness, RefusesASampleWithoutForceAndOneThatIsFarTooWeak) {
  Protocol protocol = protocol_from(protocol_text("design = \"abx\"\nloudness = \"rms\"", strokes));
  Protocol silent = protocol;
  std::get<StrokesToAndFro>(silent.motion->axes.at(0).script).to = 0.52;
  EXPECT_THAT([&] { match_loudness(silent); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("has no force along the [motion]")));
  protocol.samples[1].law.law = models::Law::make("kelvin", std::vector{1e-3, 1e-3, 1e-3});
  EXPECT_THAT([&] { match_loudness(protocol); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("too unlike")));
}

// A hand gives way to a stiffer law: what is as strong along a motion is not as it is felt.
TEST(ExampleSessions, MakeSamplesAsStrongAsTheyAreFelt) {
  for (const std::string name : test::example_protocols) {
    const Loudness loudness = test::example_protocol(name).loudness;
    EXPECT_TRUE(loudness != Loudness::rms && loudness != Loudness::peak) << name;
  }
}

TEST(ExampleSessions, CanBePlannedAndRendered) {
  for (const std::string name : test::example_protocols) {
    Protocol protocol = test::example_protocol(name);
    EXPECT_NO_THROW(match_loudness(protocol)) << name;
    for (std::size_t sample = 0; sample < protocol.samples.size(); ++sample)
      EXPECT_GT(peak_of(forces_of(protocol, sample)), 0.3) << name << " " << sample;
    for (const double level : protocol.scale.levels)
      EXPECT_NO_THROW((void)played(protocol, 0, level)) << name;
    EXPECT_GT(make_plans(protocol, 2, 1)[1].size(), 20U) << name;
  }
}

}  // namespace
}  // namespace kerf::bench

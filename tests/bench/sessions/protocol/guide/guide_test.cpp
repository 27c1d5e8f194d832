#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "felt/led_hand.h"
#include "protocol/samples.h"

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr auto led_by = R"([guide]
kind = "target"
from = { value = 32, unit = "deg" }
to = { value = 8, unit = "deg" }
)";

Protocol with_guide(const std::string& guide, const std::string& top = "design = \"abx\"\n") {
  return test::protocol_from(test::protocol_text(top, guide));
}

TEST(Guide, IsReadWithItsUnits) {
  const Protocol protocol = with_guide(std::string(led_by) + R"(stroke = { value = 600, unit = "ms" }
pause = { value = 100, unit = "ms" }
tool = false
when = "trials"
felt = { stiffness = { value = 5, unit = "N/rad" }, limit = { value = 0.4, unit = "N" } }
)");
  const GuidedMotion& guide = *protocol.guide;
  EXPECT_EQ(guide.kind, GuideKind::strokes);
  EXPECT_NEAR(guide.from, 32.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_NEAR(guide.cycle_s(), 1.4, 1e-12);
  EXPECT_FALSE(guide.shows_tool);
  EXPECT_EQ(guide.position_unit, "rad");
  EXPECT_EQ(guide.felt->stiffness, 5.0);
  EXPECT_EQ(guide.felt->damping, 0.0);
  EXPECT_TRUE(guide.leads(false));
  EXPECT_FALSE(guide.leads(true));
  EXPECT_FALSE(with_guide("").guide);
}

TEST(Guide, MayBeABeatAlone) {
  const Protocol protocol =
      with_guide("[guide]\nkind = \"metronome\"\nperiod = { value = 0.5, unit = \"s\" }\n");
  EXPECT_FALSE(protocol.guide->has_target());
  EXPECT_EQ(protocol.guide->cycle_s(), 0.5);
  EXPECT_FALSE(protocol.motion) << "a beat says nothing of a way";
}

TEST(Guide, IsTheMotionAlongWhichForcesAreMadeEqual) {
  for (const char* const how : {"", "frequency = { value = 0.7, unit = \"Hz\" }\n"}) {
    const Protocol protocol = with_guide(std::string(led_by) + how, "design = \"abx\"\nloudness = \"rms\"\n");
    ASSERT_TRUE(protocol.motion);
    const SampledMotion along = motion_along(protocol, protocol.samples[0].law);
    ASSERT_GE(static_cast<double>(along.ticks()) * 1e-3, 4.0);
    for (std::size_t tick = 0; tick < along.ticks(); tick += 7) {
      const GuideTarget target = protocol.guide->at(along.time_s[tick]);
      ASSERT_NEAR(along.sample[tick].position[0], target.position, 1e-12) << how << tick;
      ASSERT_NEAR(along.sample[tick].velocity[0], target.speed, 1e-9) << how << tick;
    }
    Protocol matched = protocol;
    match_loudness(matched);
    EXPECT_NE(matched.samples[1].gain, 1.0);
  }
  EXPECT_THROW((void)with_guide(std::string(led_by) + "when = \"practice\"\n",
                                "design = \"abx\"\nloudness = \"rms\"\npractice = 1\n"),
               std::invalid_argument)
      << "trials that nothing leads have no motion";
  const Protocol own = with_guide(std::string(led_by) + R"([motion]
from = { value = 20, unit = "deg" }
to = { value = 10, unit = "deg" }
)");
  EXPECT_NE(motion_along(own, own.samples[0].law).sample[0].position[0], own.guide->from);
}

TEST(Guide, PullsToTheTargetAndNoHarderThanItsLimit) {
  GuidedMotion guide{.kind = GuideKind::strokes, .from = 0.5, .to = 0.1};
  EXPECT_EQ(guide.pull({.position = 0.3}, 0.1, 0.0), 0.0) << "it is only seen";
  guide.felt = FeltGuide{.stiffness = 10.0, .damping = 0.5, .limit = 1.0};
  EXPECT_NEAR(guide.pull({.position = 0.3, .speed = 0.2}, 0.25, 0.0), 0.6, 1e-12);
  EXPECT_NEAR(guide.pull({.position = 0.3}, 0.35, 0.0), -0.5, 1e-12);
  EXPECT_EQ(guide.pull({.position = 0.3}, -5.0, 0.0), 1.0);
  EXPECT_EQ(guide.pull({.position = 0.3}, 5.0, 0.0), -1.0);
}

TEST(Guide, SaysInWordsWhatItWas) {
  const Protocol protocol = with_guide(
      std::string(led_by) +
      "felt = { stiffness = { value = 5, unit = \"N/rad\" }, limit = { value = 0.4, unit = \"N\" } }\n");
  EXPECT_THAT(in_words(*protocol.guide),
              AllOf(HasSubstr("from 0.5585 to 0.1396 rad"), HasSubstr("strokes of minimum jerk of 0.8 s"),
                    HasSubstr("a spring of 5 N/rad"), HasSubstr("at most 0.4 N"),
                    HasSubstr("recorded apart from the law's")));
}

struct BadGuide {
  const char* name;
  std::string text;
  const char* message;
};
void PrintTo(const BadGuide& bad, std::ostream* out) { *out << bad.name; }
class BadGuides : public testing::TestWithParam<BadGuide> {};

TEST_P(BadGuides, AreRefusedWithTheLine) {
  EXPECT_THAT([] { (void)with_guide(GetParam().text); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("p.protocol.toml:"), HasSubstr(GetParam().message))));
}

std::string target_with(const std::string& more) { return std::string(led_by) + more; }

const BadGuide bad_guides[] = {
    {"NoKind", "[guide]\n", "needs a 'kind'"},
    {"Kind", "[guide]\nkind = \"rail\"\n", "expected one of \"metronome\", \"target\""},
    {"NoPeriod", "[guide]\nkind = \"metronome\"\n", "needs its 'period'"},
    {"ShortPeriod", "[guide]\nkind = \"metronome\"\nperiod = { value = 0.1, unit = \"s\" }\n",
     "from 0.2 to 60 s"},
    {"PeriodOfATarget", target_with("period = { value = 1, unit = \"s\" }\n"), "unknown key 'period'"},
    {"TargetOfABeat", "[guide]\nkind = \"metronome\"\nfrom = { value = 1, unit = \"deg\" }\n",
     "unknown key 'from'"},
    {"NoTo", "[guide]\nkind = \"target\"\nfrom = { value = 1, unit = \"deg\" }\n", "'to'"},
    {"Stands",
     "[guide]\nkind = \"target\"\nfrom = { value = 1, unit = \"deg\" }\nto = { value = 1, unit = \"deg\" }\n",
     "the target stands"},
    {"Unit",
     "[guide]\nkind = \"target\"\nfrom = { value = 1, unit = \"mm\" }\nto = { value = 2, unit = \"mm\" }\n",
     "expected rad"},
    {"SineAndStroke",
     target_with("frequency = { value = 1, unit = \"Hz\" }\nstroke = { value = 1, unit = \"s\" }\n"),
     "with 'frequency' the target is a sine"},
    {"Fast", target_with("frequency = { value = 50, unit = \"Hz\" }\n"), "from 0.02 to 5 Hz"},
    {"When", target_with("when = \"later\"\n"), "\"both\", \"practice\", \"trials\""},
    {"NoPractice", target_with("when = \"practice\"\n"), "expected 'practice' above 0"},
    {"FeltWithoutLimit", target_with("felt = { stiffness = { value = 5, unit = \"N/rad\" } }\n"),
     "needs 'limit'"},
    {"FeltWithoutStiffness", target_with("felt = { limit = { value = 5, unit = \"N\" } }\n"),
     "needs 'stiffness'"},
    {"FeltOfNothing",
     target_with(
         "felt = { stiffness = { value = 0, unit = \"N/rad\" }, limit = { value = 1, unit = \"N\" } }\n"),
     "'stiffness' of [guide] is 0"},
    {"FeltUnit",
     target_with("felt = { stiffness = { value = 5, unit = \"N\" }, limit = { value = 1, unit = \"N\" } }\n"),
     "expected N/rad"},
    {"OffTargetWithoutGuide", "[trial]\nvoid = { off_target = { value = 2, unit = \"deg\" } }\n",
     "a distance to the target of a [guide], and there is none"},
    {"OffTargetOfABeat",
     "[guide]\nkind = \"metronome\"\nperiod = { value = 1, unit = \"s\" }\n[trial]\nvoid = { off_target = { "
     "value "
     "= 2, unit = \"deg\" } }\n",
     "and there is none"},
    {"OffTargetUnit", target_with("[trial]\nvoid = { off_target = { value = 2, unit = \"N\" } }\n"),
     "expected rad"},
    {"OffTargetZero", target_with("[trial]\nvoid = { off_target = { value = 0, unit = \"deg\" } }\n"),
     "above 0"},
};
INSTANTIATE_TEST_SUITE_P(All, BadGuides, testing::ValuesIn(bad_guides),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Guide, OfLawsOnOtherAxesIsRefused) {
  EXPECT_THAT(
      [] {
        (void)test::protocol_from(test::protocol_text(
            "design = \"abx\"",
            "[[sample]]\nname = \"x\"\nlaw = \"linear.law.toml\"\n[[sample]]\nname = "
            "\"y\"\nlaw = \"linear.law.toml\"\n[[tissue]]\nname = \"a\"\nsamples = [\"soft\", "
            "\"stiff\"]\n[[tissue]]\nname = \"b\"\nsamples = [\"x\", \"y\"]\n" +
                std::string(led_by)));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("one target cannot lead along both")));
}

TEST(Guide, HasAnExampleWhoseSlotsBeginAlike) {
  const Protocol protocol = test::example_protocol(test::guided_example);
  ASSERT_TRUE(protocol.guide && protocol.guide->felt);
  const double each = (protocol.interval_s + protocol.gap_s) / protocol.guide->cycle_s();
  EXPECT_NEAR(each, std::round(each), 1e-9);
  EXPECT_NEAR(*protocol.rules.off_target, 10.0 * std::numbers::pi / 180.0, 1e-12);
}

TEST(LedHand, KeepsToTheTargetWhereTheDeviceKnowsHow) {
  const Protocol protocol = with_guide(led_by);
  EXPECT_EQ(led_hand("sim:scissors?seed=3", protocol),
            "sim:scissors?seed=3&target=strokes&begins=open&open=32deg&close=8deg&stroke=0.8s&pause=0.25s");
  EXPECT_EQ(led_hand("sim:pose6", protocol), "sim:pose6");
  EXPECT_EQ(led_hand("sim:scissors?open=20deg", protocol), "sim:scissors?open=20deg") << "it says itself";
  EXPECT_EQ(led_hand("sim:scissors", with_guide("")), "sim:scissors");
  const Protocol up = with_guide(R"([guide]
kind = "target"
from = { value = 10, unit = "deg" }
to = { value = 30, unit = "deg" }
frequency = { value = 0.5, unit = "Hz" }
)");
  EXPECT_EQ(led_hand("sim:scissors", up),
            "sim:scissors?target=sine&begins=closed&open=30deg&close=10deg&stroke=1s&pause=0s");
}

}  // namespace
}  // namespace kerf::bench

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "protocol/protocol.h"
#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

using psychophysics::Shape;
using test::level_text;
using test::protocol_from;
using testing::AllOf;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

TEST(SessionScale, ReadsConstantLevelsInOrder) {
  const IntensityScale scale =
      protocol_from(level_text("design = \"constant\"",
                               "standard = \"soft\"\nvary = [\"parallel_stiffness\", \"damping\"]\nlevels = "
                               "[0.4, 0.1, 0.2]\nshape = \"logistic\""))
          .scale;
  EXPECT_THAT(scale.parameters, ElementsAre("parallel_stiffness", "damping"));
  EXPECT_THAT(scale.levels, ElementsAre(0.1, 0.2, 0.4));
  EXPECT_FALSE(scale.two_sided());
  EXPECT_EQ(scale.shape, Shape::logistic);
}

TEST(SessionScale, OfBothSidesHasACurveWithoutLogarithms) {
  const IntensityScale scale =
      protocol_from(level_text("design = \"constant\"", "vary = \"force\"\nlevels = [-0.2, 0, 0.2]")).scale;
  EXPECT_THAT(scale.parameters, IsEmpty());
  EXPECT_TRUE(scale.two_sided());
  EXPECT_EQ(scale.shape, Shape::gaussian);
}

TEST(SessionScale, ReadsAStaircase) {
  const Protocol protocol = protocol_from(level_text(
      "design = \"staircase\"\ntrials = 50",
      "vary = \"force\"\nstaircase = { up = 2, down = 3, start = 0.3, steps = [0.1, 0.05], "
      "step_ratio = 0.5, axis = \"linear\", least = 0.01, most = 0.6, reversals = 8, dropped = 2 }"));
  const psychophysics::StaircaseOptions& options = protocol.scale.staircase;
  EXPECT_EQ(options.up, 2);
  EXPECT_EQ(options.down, 3);
  EXPECT_EQ(options.start, 0.3);
  EXPECT_THAT(options.steps, ElementsAre(0.1, 0.05));
  EXPECT_EQ(options.step_ratio, 0.5);
  EXPECT_EQ(options.axis, psychophysics::Axis::linear);
  EXPECT_EQ(options.least, 0.01);
  EXPECT_EQ(options.most, 0.6);
  EXPECT_EQ(options.reversals, 8);
  EXPECT_EQ(options.dropped, 2);
  EXPECT_EQ(options.max_trials, 50);
}

TEST(SessionScale, HoldsAStaircaseWithinFourTimesItsStart) {
  const Protocol protocol =
      protocol_from(level_text("design = \"staircase\"", "vary = \"force\"\nstaircase = { start = 0.2 }"));
  EXPECT_DOUBLE_EQ(protocol.scale.staircase.most, 0.8);
  EXPECT_DOUBLE_EQ(protocol.scale.staircase.least, 0.0002);
  EXPECT_EQ(protocol.trials, 100U);
}

TEST(SessionScale, OfQuestHasLevelsFromATenthToTenTimesTheExpectedJnd) {
  const Protocol protocol = protocol_from(
      level_text("design = \"quest\"", "vary = \"force\"\nquest = { trials = 40, expected_jnd = 0.08 }"));
  ASSERT_THAT(protocol.scale.levels, SizeIs(33));
  EXPECT_EQ(protocol.scale.levels.front(), 0.008);
  EXPECT_EQ(protocol.scale.levels[16], 0.08);
  EXPECT_EQ(protocol.scale.levels.back(), 0.8);
  EXPECT_EQ(protocol.scale.levels[1], 0.009238);  // 0.008 * 10^(1/16), to four digits
  EXPECT_EQ(protocol.scale.quest_trials, 40U);
  EXPECT_EQ(protocol.trials, 40U);
}

TEST(SessionScale, OfQuestHasItsTrialsFromTheTopToo) {
  const Protocol protocol =
      protocol_from(level_text("design = \"quest\"\ntrials = 30", "vary = \"force\"\nlevels = [0.3, 0.1]"));
  EXPECT_EQ(protocol.scale.quest_trials, 30U);
  EXPECT_THAT(protocol.scale.levels, ElementsAre(0.1, 0.3));
}

struct BadScale {
  const char* name;
  const char* design;
  const char* scale;
  const char* message;
};
void PrintTo(const BadScale& bad, std::ostream* out) { *out << bad.name; }
class BadScales : public testing::TestWithParam<BadScale> {};

TEST_P(BadScales, AreRefusedWithTheLine) {
  const std::string top = fmt::format("design = \"{}\"", GetParam().design);
  const std::string_view name = GetParam().name;
  const char* law = name.starts_with("Tight") ? "tight" : name.starts_with("Still") ? "still" : "soft";
  EXPECT_THAT([&] { (void)protocol_from(level_text(top, GetParam().scale, law)); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("p.protocol.toml:"), HasSubstr(GetParam().message))));
}

const BadScale bad_scales[] = {
    {"Key", "constant", "vary = \"force\"\nlevels = [0.1]\nstaircase = { start = 1 }",
     "unknown key 'staircase' in the [scale] of constant levels"},
    {"NoVary", "constant", "levels = [0.1]", "needs 'vary'"},
    {"VaryWord", "constant", "vary = \"damping\"\nlevels = [0.1]", "must be \"force\" or an array"},
    {"VaryUnknown", "constant", "vary = [\"mass\"]\nlevels = [0.1]",
     ":8: law 'kelvin' has no parameter \"mass\""},
    {"VaryTwice", "constant", "vary = [\"damping\", \"damping\"]\nlevels = [0.1]", "is named twice"},
    {"StillNothing", "constant", "vary = [\"offset\"]\nlevels = [0.1]", "stays 0 at every level"},
    {"TightBounds", "constant", "vary = [\"order\"]\nlevels = [0.5, 1.5]", "cannot be played at level 1.5"},
    {"TightStaircase", "staircase", "vary = [\"order\"]\nstaircase = { start = 0.5, most = 1.5 }",
     "cannot be played at level 1.5"},
    {"TightQuest", "quest", "vary = [\"order\"]\nquest = { expected_jnd = 0.5 }",
     "cannot be played at level 5"},
    {"UnknownStandard", "constant", "standard = \"hard\"\nvary = \"force\"\nlevels = [0.1]",
     "no sample \"hard\""},
    {"NoLevels", "constant", "vary = \"force\"", "needs 'levels'"},
    {"EmptyLevels", "constant", "vary = \"force\"\nlevels = []", "array of 1 to 200 numbers"},
    {"LevelTwice", "constant", "vary = \"force\"\nlevels = [0.1, 0.1]", "level 0.1 is there twice"},
    {"LevelAll", "constant", "vary = \"force\"\nlevels = [-1, 0.1]", "level -1 is not above -1"},
    {"LevelInfinite", "constant", "vary = \"force\"\nlevels = [inf]", "level inf"},
    {"LevelNan", "constant", "vary = \"force\"\nlevels = [nan]", "level nan"},
    {"LevelZero", "constant", "vary = \"force\"\nlevels = [0, 0.1]", "level 0 is not above 0"},
    {"LevelBelow", "constant", "vary = \"force\"\nlevels = [-0.2, -0.1]", "lie on both sides"},
    {"LevelBelowQuest", "quest", "vary = \"force\"\nlevels = [-0.2, 0.1]", "has levels above 0 only"},
    {"WeibullOnBothSides", "constant", "vary = \"force\"\nlevels = [-0.1, 0.1]\nshape = \"weibull\"",
     "a Weibull curve"},
    {"Shape", "constant", "vary = \"force\"\nlevels = [0.1]\nshape = \"cauchy\"", "'shape' is \"cauchy\""},
    {"StaircaseMissing", "staircase", "vary = \"force\"", "expected a table [staircase]"},
    {"StaircaseWithoutStart", "staircase", "vary = \"force\"\nstaircase = {}", "needs 'start'"},
    {"StaircaseLevels", "staircase", "vary = \"force\"\nlevels = [0.1]\nstaircase = { start = 0.4 }",
     "unknown key 'levels'"},
    {"StaircaseStart", "staircase", "vary = \"force\"\nstaircase = { start = 0.4, most = 0.3 }",
     "must start between its least and its largest"},
    {"StaircaseSteps", "staircase", "vary = \"force\"\nstaircase = { start = 0.4, steps = [0] }",
     "a step is 0"},
    {"StaircaseReversals", "staircase",
     "vary = \"force\"\nstaircase = { start = 0.4, reversals = 3, dropped = 2 }",
     "two reversals more than it drops"},
    {"QuestJnd", "quest", "vary = \"force\"\nquest = { expected_jnd = 0 }", "'expected_jnd' is 0"},
    {"QuestTrials", "quest", "vary = \"force\"\nquest = { trials = 0 }", "'trials' is 0"},
    {"QuestKey", "quest", "vary = \"force\"\nquest = { slope = [1] }", "unknown key 'slope'"},
    {"QuestFalls", "quest", "vary = \"force\"\nquest = { slopes = [2, 1] }", "has 1 after 2"},
    {"QuestNone", "quest", "vary = \"force\"\nquest = { lapses = [] }", "array of 1 to 200 numbers"},
    {"QuestThreshold", "quest", "vary = \"force\"\nquest = { thresholds = [0] }", "expected 1e-06 to 100"},
    {"QuestGridEnds", "quest", "vary = \"force\"\nquest = { thresholds = { from = 0.2, to = 0.1 } }",
     "from 0.2 to 0.1, expected it to rise"},
    {"QuestGridKey", "quest", "vary = \"force\"\nquest = { slopes = { from = 1 } }", "'slopes' needs 'to'"},
    {"QuestLapsesInRatios", "quest", "vary = \"force\"\nquest = { lapses = { from = 0, to = 0.1 } }",
     "must be an array"},
    {"QuestNoCurve", "quest", "vary = \"force\"\nquest = { guesses = [0.5, 0.9], lapses = [0.1] }",
     "leave no curve"},
    {"QuestNuisance", "quest", "vary = \"force\"\nquest = { nuisance = [\"threshold\"] }",
     "'threshold' is no nuisance"},
    {"QuestNuisanceTwice", "quest", "vary = \"force\"\nquest = { nuisance = [\"slope\", \"slope\"] }",
     "named twice"},
    {"QuestNuisanceKnown", "quest", "vary = \"force\"\nquest = { nuisance = [\"guess\"] }",
     "the guess rate is known"},
    {"QuestUntil", "quest", "vary = \"force\"\nquest = { until = { least = 20 } }", "needs 'ratio'"},
    {"QuestUntilNever", "quest", "vary = \"force\"\nquest = { until = { ratio = 1 } }", "'ratio' is 1"},
    {"QuestUntilLate", "quest",
     "vary = \"force\"\nquest = { trials = 30, until = { ratio = 2, least = 31 } }", "'least' is 31"},
    {"QuestSize", "quest",
     "vary = \"force\"\nquest = { thresholds = { from = 0.01, to = 1, count = 200 }, slopes = { from = 1, to "
     "= "
     "8, count = 200 } }",
     "120000 points and 33 levels"},
    {"StaircaseAlone", "staircase", "vary = \"force\"\nstaircase = [{ start = 0.4 }]", "array of 2 to 8"},
    {"StaircaseOther", "staircase", "vary = \"force\"\nstaircase = [{ start = 0.4 }, { up = 1 }]",
     "needs 'start'"},
};
const auto name_of_bad_scale = [](const auto& tested) { return std::string(tested.param.name); };
INSTANTIATE_TEST_SUITE_P(Scales, BadScales, testing::ValuesIn(bad_scales), name_of_bad_scale);

void expect_refused(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { (void)protocol_from(text); }, ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
}

TEST(SessionScale, OfQuestTakesItsGrids) {
  const Protocol protocol = protocol_from(level_text("design = \"quest\"", R"(vary = "force"
quest = { trials = 80, thresholds = { from = 0.02, to = 0.5, count = 3 }, slopes = [2, 4], guesses = [0.45, 0.5], lapses = [0, 0.05, 0.1], nuisance = ["slope", "lapse"], until = { ratio = 2.5, confidence = 0.9, least = 30 } })"));
  const psychophysics::QuestPlusOptions options = quest_options_of(protocol.scale, 0.5);
  EXPECT_THAT(options.thresholds, ElementsAre(DoubleEq(0.02), DoubleEq(0.1), DoubleEq(0.5)));
  EXPECT_THAT(options.slopes, ElementsAre(2.0, 4.0));
  EXPECT_THAT(options.guesses, ElementsAre(0.45, 0.5));
  EXPECT_THAT(options.lapses, ElementsAre(0.0, 0.05, 0.1));
  EXPECT_TRUE(options.nuisance.slope && options.nuisance.lapse && !options.nuisance.guess);
  EXPECT_EQ(options.narrow, 2.5);
  EXPECT_EQ(options.narrow_confidence, 0.9);
  EXPECT_EQ(options.least_trials, 30);
  EXPECT_EQ(options.trials, 80);
  EXPECT_NEAR(protocol.scale.levels.front(), 0.01, 1e-12) << "a tenth of the middle of the thresholds";
  EXPECT_TRUE(ends_by_answers(protocol.design, protocol.scale));
}

TEST(SessionScale, OfQuestWithoutGridsIsAsItEverWas) {
  const Protocol protocol =
      protocol_from(level_text("design = \"quest\"", "vary = \"force\"\nquest = { expected_jnd = 0.08 }"));
  const psychophysics::QuestPlusOptions options = quest_options_of(protocol.scale, 0.5);
  EXPECT_EQ(options.thresholds, psychophysics::geometric_grid(0.008, 0.8, 41));
  EXPECT_EQ(options.slopes, psychophysics::QuestPlusOptions{}.slopes);
  EXPECT_FALSE(options.nuisance.any());
  EXPECT_FALSE(ends_by_answers(protocol.design, protocol.scale));
}

TEST(SessionScale, OfStaircasesHasEachItsRule) {
  const Protocol protocol = protocol_from(level_text(
      "design = \"staircase\"",
      "vary = \"force\"\nstaircase = [{ start = 0.4 }, { start = 0.05, down = 3, step_ratio = 0.5 }]"));
  ASSERT_EQ(protocol.scale.staircases().size(), 2U);
  EXPECT_EQ(protocol.scale.staircases()[0].down, 2);
  EXPECT_EQ(protocol.scale.staircases()[1].down, 3);
  EXPECT_EQ(protocol.scale.staircases()[1].step_ratio, 0.5);
}

TEST(SessionScale, IsNeededWhereTheDesignHasLevels) {
  std::string text = level_text("design = \"constant\"", "");
  text.erase(text.find("[scale]"));
  expect_refused(text, "needs a table [scale]");
}

TEST(SessionScale, ComparesOneSampleWithItself) {
  const Protocol protocol =
      protocol_from(level_text("design = \"constant\"", "vary = \"force\"\nlevels = [0.1]"));
  EXPECT_THAT(pairs_of(protocol, 0), ElementsAre(ElementsAre(0, 0)));
  expect_refused(level_text("design = \"constant\"",
                            "vary = \"force\"\nlevels = [0.1]\n[[sample]]\nname = "
                            "\"x\"\nlaw = \"stiff.law.toml\""),
                 "a design of levels has one");
}

TEST(SessionScale, GivesNoFeedbackAndNoLoudnessWhereTheyMeanNothing) {
  expect_refused(level_text("design = \"constant\"\npractice = 2\nfeedback = true",
                            "vary = \"force\"\nlevels = [-0.1, 0.1]"),
                 "no answer is right");
  expect_refused(level_text("design = \"constant\"\nloudness = \"rms\"", "vary = \"force\"\nlevels = [0.1]"),
                 "leave 'loudness' out");
  expect_refused(level_text("design = \"quest\"\ntrials = 3", "vary = \"force\"\nquest = { trials = 3 }"),
                 "leave out either");
}

}  // namespace
}  // namespace kerf::bench

#include "protocol/trial_sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/psychophysics/random.h>

#include "bench/sessions/protocol/written_protocol.h"

namespace kerf::bench {
namespace {

using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::HasSubstr;
using testing::ThrowsMessage;

TrialSequence sequence_of(const Protocol& protocol) { return {protocol, make_plans(protocol, 1, 5).front()}; }

/// Right where a level is felt.
std::size_t answer_of(const Protocol& protocol, const TrialPlan& trial, bool is_right) {
  const std::size_t right = trial.right(protocol);
  return is_right ? right : 1 - right;
}

Protocol staircase(const std::string& top = "trials = 60", const std::string& more = "") {
  return protocol_from(level_text(
      fmt::format("design = \"staircase\"\n{}", top),
      fmt::format("vary = \"force\"\nstaircase = {{ start = 0.4, steps = [0.5, 0.25]{} }}", more)));
}
Protocol quest(const std::string& top = "trials = 40") {
  return protocol_from(level_text(fmt::format("design = \"quest\"\n{}", top),
                                  "vary = \"force\"\nquest = { expected_jnd = 0.1 }"));
}

TEST(SessionCourse, OfAFixedDesignIsItsPlan) {
  const Protocol protocol = protocol_from(
      level_text("design = \"constant\"\ntrials = 3\npractice = 2", "vary = \"force\"\nlevels = [0.1, 0.2]"));
  const Plan plan = make_plans(protocol, 1, 5).front();
  TrialSequence sequence(protocol, plan);
  EXPECT_EQ(sequence.at_most(), 8U);
  for (const TrialPlan& trial : plan) {
    ASSERT_TRUE(sequence.next());
    EXPECT_EQ(sequence.next()->slots, trial.slots);
    EXPECT_EQ(sequence.next()->level, trial.level);
    sequence.answer(1);
  }
  EXPECT_EQ(sequence.answered(), 8U);
  EXPECT_FALSE(sequence.next());
  EXPECT_THAT([&] { sequence.answer(0); }, ThrowsMessage<std::invalid_argument>(HasSubstr("is over")));
}

TEST(SessionCourse, TakesOnlyWhatIsAnAnswer) {
  TrialSequence sequence = sequence_of(protocol_from(protocol_text("design = \"abx\"")));
  EXPECT_THAT([&] { sequence.answer(2); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("slot 2 is no answer")));
  EXPECT_EQ(sequence.answered(), 0U);
}

TEST(SessionCourse, OfAStaircaseGoesDownAfterTwoRightAndUpAfterOneWrong) {
  const Protocol protocol = staircase();
  TrialSequence sequence = sequence_of(protocol);
  const auto answer = [&](bool is_right) {
    sequence.answer(answer_of(protocol, *sequence.next(), is_right));
  };
  EXPECT_DOUBLE_EQ(sequence.next()->level, 0.4);
  answer(true);
  EXPECT_DOUBLE_EQ(sequence.next()->level, 0.4);
  answer(true);
  EXPECT_NEAR(sequence.next()->level, 0.4 * std::exp(-0.5), 1e-12);
  answer(false);
  EXPECT_NEAR(sequence.next()->level, 0.4 * std::exp(-0.25), 1e-12) << "the smaller step after a reversal";
}

TEST(SessionCourse, OfAStaircaseEndsWithItsReversals) {
  const Protocol protocol = staircase("trials = 60", ", reversals = 6, dropped = 2");
  TrialSequence sequence = sequence_of(protocol);
  while (const auto trial = sequence.next())
    sequence.answer(answer_of(protocol, *trial, trial->level > 0.15));
  EXPECT_GT(sequence.answered(), 8U);
  EXPECT_LT(sequence.answered(), 40U);
  EXPECT_EQ(sequence.at_most(), 60U);
}

TEST(SessionCourse, OfAStaircaseEndsAtTheMostTrials) {
  const Protocol protocol = staircase("trials = 7\npractice = 2");
  TrialSequence sequence = sequence_of(protocol);
  while (const auto trial = sequence.next()) sequence.answer(answer_of(protocol, *trial, true));
  EXPECT_EQ(sequence.answered(), 9U);
}

TEST(SessionCourse, PractisesAtALevelThatIsEasyWithoutLearningFromIt) {
  const Protocol protocol = staircase("practice = 3");
  TrialSequence sequence = sequence_of(protocol);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(sequence.next()->practice);
    EXPECT_EQ(sequence.next()->level, 0.4);
    sequence.answer(answer_of(protocol, *sequence.next(), i == 0));
  }
  EXPECT_FALSE(sequence.next()->practice);
  EXPECT_DOUBLE_EQ(sequence.next()->level, 0.4);
  EXPECT_EQ(sequence_of(quest("practice = 1")).next()->level, 1.0) << "the largest level there is";
}

TEST(SessionCourse, OfQuestComesToTheLevelThatTheSubjectFeels) {
  const Protocol protocol = quest();
  TrialSequence sequence = sequence_of(protocol);
  double last = 0.0;
  while (const auto trial = sequence.next()) {
    EXPECT_EQ(std::ranges::count(protocol.scale.levels, trial->level), 1);
    last = trial->level;
    sequence.answer(answer_of(protocol, *trial, trial->level >= 0.2 || sequence.answered() % 2 == 0));
  }
  EXPECT_EQ(sequence.answered(), 40U);
  EXPECT_GT(last, 0.1);
  EXPECT_LT(last, 0.3);
}

TEST(SessionCourse, IsResumedByTheRecordedAnswers) {
  for (const Protocol& protocol :
       {staircase("trials = 40\npractice = 2"), quest("trials = 25\npractice = 2")}) {
    psychophysics::Random random(11);
    const Plan plan = make_plans(protocol, 1, 5).front();
    TrialSequence sequence(protocol, plan);
    std::vector<std::size_t> answers;
    while (const auto trial = sequence.next()) {
      TrialSequence resumed(protocol, plan);
      for (const std::size_t answer : answers) resumed.answer(answer);
      ASSERT_TRUE(resumed.next());
      EXPECT_EQ(resumed.next()->level, trial->level);
      EXPECT_EQ(resumed.next()->slots, trial->slots);
      answers.push_back(random.below(2));
      sequence.answer(answers.back());
    }
    EXPECT_GT(answers.size(), 10U);
  }
}

TEST(SessionCourse, BreaksAfterEverySoManyTrialsThatCount) {
  TrialSequence sequence =
      sequence_of(protocol_from(protocol_text("design = \"abx\"\ntrials = 6\npractice = 2\nbreak = { every = "
                                              "2, at_least = { value = 1, unit = \"s\" } }")));
  std::vector<std::size_t> before;
  for (; sequence.next(); sequence.answer(0)) {
    if (sequence.break_due()) before.push_back(sequence.answered());
  }
  EXPECT_THAT(before, testing::ElementsAre(4, 6)) << "after two and four of six, past two of practice";
  EXPECT_FALSE(sequence.break_due());
}

TEST(SessionCourse, GoesOnWithoutBreaksWhereNoneAreAskedFor) {
  TrialSequence sequence = sequence_of(protocol_from(protocol_text("design = \"abx\"\ntrials = 6")));
  for (; sequence.next(); sequence.answer(0)) EXPECT_FALSE(sequence.break_due());
}

Protocol interleaved(const std::string& top = "trials = 80") {
  return protocol_from(level_text(fmt::format("design = \"staircase\"\n{}", top), R"(vary = "force"
[[scale.staircase]]
start = 0.4
steps = [0.5, 0.25]
[[scale.staircase]]
start = 0.05
down = 3
steps = [0.4]
reversals = 8)"));
}

TEST(SessionCourse, OfInterleavedStairsIsThatOfEachByItself) {
  const Protocol protocol = interleaved();
  TrialSequence sequence = sequence_of(protocol);
  std::vector<psychophysics::Staircase> alone;
  for (const auto& options : protocol.scale.staircases()) alone.emplace_back(options);
  psychophysics::Random random(4);
  std::array<int, 2> turns{};
  while (const std::optional<TrialPlan> trial = sequence.next()) {
    ASSERT_LT(trial->track, 2U);
    psychophysics::Staircase& own = alone[trial->track];
    ASSERT_FALSE(own.finished());
    EXPECT_EQ(trial->level, own.next());
    const bool is_right = random.chance(trial->level > 0.1 ? 0.95 : 0.6);
    own.answer(is_right);
    sequence.answer(answer_of(protocol, *trial, is_right));
    ++turns[trial->track];
  }
  EXPECT_GT(turns[0], 10);
  EXPECT_GT(turns[1], 10);
  for (const psychophysics::Staircase& each : alone)
    EXPECT_TRUE(each.finished() || sequence.answered() == sequence.at_most());
}

TEST(SessionCourse, OfInterleavedStairsTakesTurnsByChance) {
  const Protocol protocol = interleaved();
  const std::vector<Plan> plans = make_plans(protocol, 2, 5);
  std::vector<std::size_t> first;
  for (const Plan& plan : plans) {
    ASSERT_EQ(plan.size(), 80U);
    for (std::size_t block = 0; block < 80; block += 8)
      EXPECT_EQ(std::count_if(plan.begin() + static_cast<std::ptrdiff_t>(block),
                              plan.begin() + static_cast<std::ptrdiff_t>(block) + 8,
                              [](const TrialPlan& trial) { return trial.track == 1; }),
                4);
    if (first.empty()) {
      for (const TrialPlan& trial : plan) first.push_back(trial.track);
    }
  }
  std::vector<std::size_t> second;
  for (const TrialPlan& trial : plans[1]) second.push_back(trial.track);
  EXPECT_NE(first, second);
}

TEST(SessionCourse, OfInterleavedStairsPractisesAtTheEasiestStart) {
  EXPECT_DOUBLE_EQ(sequence_of(interleaved("trials = 40\npractice = 1")).next()->level, 0.4);
}

TEST(SessionCourse, OfOneStaircaseKnowsNoTurns) {
  const Plan plan = make_plans(staircase(), 1, 5).front();
  EXPECT_EQ(to_json_text(plan).find("track"), std::string::npos);
  const Plan both = make_plans(interleaved(), 1, 5).front();
  const Plan read = plan_from_json(to_json_text(both));
  for (std::size_t i = 0; i < both.size(); ++i) EXPECT_EQ(read[i].track, both[i].track);
}

TEST(SessionCourse, OfQuestEndsWithANarrowInterval) {
  const Protocol protocol = protocol_from(level_text(
      "design = \"quest\"",
      "vary = \"force\"\nquest = { trials = 200, expected_jnd = 0.1, until = { ratio = 2, least = 12 } }"));
  TrialSequence sequence = sequence_of(protocol);
  EXPECT_EQ(sequence.at_most(), 200U);
  psychophysics::Random random(9);
  while (const std::optional<TrialPlan> trial = sequence.next())
    sequence.answer(
        answer_of(protocol, *trial, random.chance(1.0 - 0.5 * std::exp(-std::pow(trial->level / 0.1, 3.0)))));
  EXPECT_GE(sequence.answered(), 12U);
  EXPECT_LT(sequence.answered(), 150U);
}

}  // namespace
}  // namespace kerf::bench

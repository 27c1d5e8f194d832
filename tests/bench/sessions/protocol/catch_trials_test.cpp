#include "protocol/attention/catch_trials.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t catch_subjects = 8;
constexpr std::uint64_t catch_seed = 20260301;
constexpr const char* third_sample = "[[sample]]\nname = \"third\"\nlaw = \"third.law.toml\"\n";

/// With a third sample that is in catch trials alone.
Protocol with_catches(const std::string& top, const std::string& rule = "every = 5\nsample = \"third\"\n") {
  return protocol_from(protocol_text(top, third_sample + ("[catch]\n" + rule)));
}

Protocol staircase_with_catches(const std::string& more = "level = 2.0\n") {
  return protocol_from(level_text("design = \"staircase\"\ntrials = 40\n",
                                  "vary = [\"parallel_stiffness\"]\nstaircase = { start = 0.5 }\n[catch]\n"
                                  "every = 5\n" +
                                      more));
}

Plan plan_of(const Protocol& protocol) { return make_plans(protocol, 1, catch_seed).front(); }

std::vector<TrialPlan> catches_in(const Plan& plan) {
  std::vector<TrialPlan> all;
  std::ranges::copy_if(plan, std::back_inserter(all), &TrialPlan::is_catch);
  return all;
}

TEST(CatchTrials, StandOneAmongSoManyAndNeverFirstNorSideBySide) {
  const Protocol protocol = with_catches("design = \"abx\"\ntrials = 40\npractice = 2\n");
  std::set<std::size_t> places;
  for (const Plan& plan : make_plans(protocol, catch_subjects, catch_seed)) {
    ASSERT_EQ(plan.size(), 2U + 40U + 8U);
    std::size_t counting = 0;
    std::size_t caught = 0;
    for (std::size_t i = 0; i < plan.size(); ++i) {
      if (plan[i].practice) continue;
      if (!plan[i].is_catch) {
        ++counting;
        continue;
      }
      EXPECT_FALSE(plan[i - 1].is_catch || plan[i - 1].practice) << "place " << i;
      EXPECT_EQ((counting - 1) / 5, caught) << "one in each five";
      places.insert((counting - 1) % 5);
      ++caught;
    }
    EXPECT_EQ(caught, 8U);
  }
  EXPECT_EQ(places.size(), 5U) << "at any place of the five";
}

TEST(CatchTrials, LeaveAllOtherTrialsAsTheyAre) {
  const std::string top = "design = \"abx\"\ntrials = 20\npractice = 3\n";
  const auto without = make_plans(protocol_from(protocol_text(top)), catch_subjects, catch_seed);
  auto with = make_plans(with_catches(top), catch_subjects, catch_seed);
  for (std::size_t subject = 0; subject < catch_subjects; ++subject) {
    std::erase_if(with[subject], [](const TrialPlan& trial) { return trial.is_catch; });
    EXPECT_EQ(to_json_text(with[subject]), to_json_text(without[subject]));
  }
}

TEST(CatchTrials, AreTheSameOfTheSameSeedAndOthersOfAnother) {
  const Protocol protocol = with_catches("design = \"abx\"\ntrials = 20\n");
  const auto text = [&](std::uint64_t seed) { return to_json_text(make_plans(protocol, 1, seed).front()); };
  EXPECT_EQ(text(1), text(1));
  EXPECT_NE(text(1), text(2));
}

TEST(CatchTrials, HaveTheSlotsFilledEachWayEquallyOften) {
  const Protocol protocol = with_catches("design = \"abx\"\ntrials = 40\n");
  for (const Plan& plan : make_plans(protocol, catch_subjects, catch_seed)) {
    std::map<std::array<std::uint8_t, max_slots>, int> ways;
    std::map<std::size_t, int> partners;
    for (const TrialPlan& trial : catches_in(plan)) {
      ++ways[trial.slots];
      ++partners[trial.pair[0]];
      EXPECT_EQ(trial.pair[1], 2U);
    }
    EXPECT_EQ(ways.size(), 4U);
    for (const auto& [way, count] : ways) EXPECT_EQ(count, 2);
    EXPECT_EQ(partners, (std::map<std::size_t, int>{{0, 4}, {1, 4}}));
  }
}

TEST(CatchTrials, HaveTheirSampleInNoOtherTrial) {
  const Protocol protocol = with_catches("design = \"preference\"\ntrials = 20\n");
  EXPECT_EQ(protocol.tissues.front().samples, (std::vector<std::size_t>{0, 1}));
  for (const TrialPlan& trial : plan_of(protocol))
    EXPECT_EQ(std::ranges::count(trial.pair, 2U), trial.is_catch ? 1 : 0);
}

struct RightOfCatch {
  std::string top;
  std::string rule;
  std::size_t right_sample;  ///< that the right slot plays
};

TEST(CatchTrials, AreRightWhereTheQuestionPoints) {
  const std::string of_signal = "trials = 20\nsignal = \"stiff\"\n";
  const std::vector<RightOfCatch> cases{
      {"design = \"preference\"\ntrials = 20\n", "is = \"more\"\n", 2},
      {"design = \"2ifc\"\n" + of_signal, "", 1},
      {"design = \"2ifc\"\n" + of_signal, "is = \"more\"\n", 2},
      {"design = \"3ifc\"\n" + of_signal, "", 1},
      {"design = \"3ifc\"\n" + of_signal, "is = \"more\"\n", 2},
  };
  for (const RightOfCatch& each : cases) {
    const Protocol protocol = with_catches(each.top, "every = 5\nsample = \"third\"\n" + each.rule);
    for (const TrialPlan& trial : catches_in(plan_of(protocol)))
      EXPECT_EQ(trial.pair[trial.slots[trial.right(protocol)]], each.right_sample) << each.top << each.rule;
  }
  const Protocol less = with_catches("design = \"preference\"\ntrials = 20\n");
  for (const TrialPlan& trial : catches_in(plan_of(less)))
    EXPECT_NE(trial.pair[trial.slots[trial.right(less)]], 2U) << "whoever prefers the least is not there";
}

TEST(CatchTrials, OfYesAndNoPlayTheirSampleAndOfSameAndDifferentAreDifferent) {
  const std::string top = "design = \"yes-no\"\ntrials = 20\nsignal = \"stiff\"\n";
  for (const bool more : {false, true}) {
    const Protocol protocol = with_catches(
        top, fmt::format("every = 5\nsample = \"third\"\nis = \"{}\"\n", more ? "more" : "less"));
    for (const TrialPlan& trial : catches_in(plan_of(protocol))) {
      EXPECT_EQ(trial.pair[trial.slots[0]], 2U);
      EXPECT_EQ(trial.right(protocol), more ? 1U : 0U);
    }
  }
  const Protocol different = with_catches("design = \"same-different\"\ntrials = 20\n");
  for (const TrialPlan& trial : catches_in(plan_of(different))) EXPECT_EQ(trial.right(different), 1U);
}

TEST(CatchTrials, AreOfTheTissueThatIsAtWork) {
  const Protocol protocol =
      protocol_from(protocol_text("design = \"abx\"\ntrials = 10\n",
                                  std::string(test::two_tissues) +
                                      "[[sample]]\nname = \"odd\"\nlaw = \"soft.law.toml\"\n[catch]\nevery = "
                                      "4\nsample = \"odd\"\n"));
  for (const Plan& plan : make_plans(protocol, catch_subjects, catch_seed)) {
    for (std::size_t i = 1; i < plan.size(); ++i) {
      if (!plan[i].is_catch) continue;
      EXPECT_EQ(plan[i].tissue, plan[i - 1].tissue);
      EXPECT_EQ(std::ranges::count(protocol.tissues[plan[i].tissue].samples, plan[i].pair[0]), 1);
    }
  }
}

TEST(CatchTrials, AreNothingThatAnAdaptiveRuleFollows) {
  for (const bool quest : {false, true}) {
    const Protocol protocol =
        quest
            ? protocol_from(level_text("design = \"quest\"\ntrials = 40\n",
                                       "vary = [\"parallel_stiffness\"]\n[catch]\nevery = 5\nlevel = 2.0\n"))
            : staircase_with_catches();
    const Plan plan = plan_of(protocol);
    Plan without = plan;
    std::erase_if(without, [](const TrialPlan& trial) { return trial.is_catch; });
    TrialSequence with(protocol, plan);
    TrialSequence alone(protocol, without);
    std::size_t caught = 0;
    std::size_t answered = 0;
    while (const std::optional<TrialPlan> trial = with.next()) {
      if (trial->is_catch) {
        EXPECT_EQ(trial->level, 2.0);
        with.answer(1 - trial->right(protocol));
        ++caught;
        continue;
      }
      const std::optional<TrialPlan> other = alone.next();
      ASSERT_TRUE(other.has_value());
      EXPECT_EQ(trial->level, other->level);
      const std::size_t answer = ++answered % 4 == 0 ? 1 - trial->right(protocol) : trial->right(protocol);
      with.answer(answer);
      alone.answer(answer);
    }
    EXPECT_FALSE(alone.next().has_value()) << "both end with the same trial";
    EXPECT_GE(caught, 4U);
  }
}

TEST(CatchTrials, ThatAreVoidComeAgainInTheirBlock) {
  Protocol protocol = staircase_with_catches();
  protocol.rules.fault = true;
  const Plan plan = plan_of(protocol);
  TrialSequence sequence(protocol, plan);
  std::size_t counting = 0;
  while (!sequence.next()->is_catch) {
    sequence.answer(0);
    ++counting;
  }
  const TrialPlan voided = *sequence.next();
  ASSERT_TRUE(sequence.repeat());
  std::size_t again = 0;
  std::size_t given = 0;
  while (given < 12) {
    const TrialPlan trial = *sequence.next();
    counting += trial.is_catch ? 0 : 1;
    if (trial.is_catch && counting <= block_of_slots && trial.slots == voided.slots) ++again;
    sequence.answer(0);
    ++given;
  }
  EXPECT_GE(again, 1U);
}

TEST(CatchTrials, AreReadBackFromAPlanAsJson) {
  const Plan plan = make_plans(with_catches("design = \"abx\"\ntrials = 20\n"), 1, catch_seed).front();
  const Plan again = plan_from_json(to_json_text(plan));
  EXPECT_EQ(catches_in(again).size(), 4U);
  EXPECT_EQ(to_json_text(again), to_json_text(plan));
}

TEST(CatchTrials, ThatCannotBeAreRefused) {
  const std::string abx = "design = \"abx\"\ntrials = 12\n";
  const std::string all = third_sample;
  const auto levels = [](const std::string& rule) {
    return level_text("design = \"constant\"\ntrials = 4\n",
                      "vary = [\"parallel_stiffness\"]\nlevels = [0.1, 0.3]\n[catch]\n" + rule);
  };
  const std::vector<std::pair<std::string, const char*>> bad{
      {protocol_text(abx, all + "[catch]\nsample = \"third\"\n"), "[catch] needs 'every'"},
      {protocol_text(abx, all + "[catch]\nevery = 2\nsample = \"third\"\n"), "'every' is 2, expected"},
      {protocol_text(abx, all + "[catch]\nevery = 13\nsample = \"third\"\n"),
       "'every' is 13, and a session has 12 trials: there would be none"},
      {protocol_text(abx, "[catch]\nevery = 5\n"), "[catch] needs 'sample'"},
      {protocol_text(abx, "[catch]\nevery = 5\nsample = \"fourth\"\n"), "there is no sample \"fourth\""},
      {protocol_text(abx, "[catch]\nevery = 5\nsample = \"soft\"\n"), "has one sample; expected two or more"},
      {protocol_text(abx, all + "[catch]\nevery = 5\nsample = \"third\"\nis = \"more\"\n"),
       "'is' of [catch] says whether"},
      {protocol_text(abx, all + "[catch]\nevery = 5\nsample = \"third\"\nlevel = 1.0\n"),
       "'level' of [catch] is for designs of levels"},
      {protocol_text(abx, all + "[catch]\nevery = 5\nsample = \"third\"\nodd = 1\n"), "unknown key 'odd'"},
      {protocol_text(abx, std::string(test::two_tissues) + "[catch]\nevery = 5\nsample = \"third\"\n"),
       "sample 'third' is that of [catch]"},
      {protocol_text(abx,
                     "[[sample]]\nname = \"far\"\nlaw = \"linear.law.toml\"\n[catch]\nevery = 5\nsample = "
                     "\"far\"\n"),
       "cannot be compared"},
      {protocol_text("design = \"rating\"\nends = [\"not\", \"very\"]\ntrials = 12\n",
                     all + "[catch]\nevery = 5\nsample = \"third\"\n"),
       "'rating' asks for a number, of which none is right"},
      {levels("every = 5\n"), "needs 'level'"},
      {levels("every = 5\nlevel = 0.3\n"), "'level' is 0.3, expected more than 0.3"},
      {levels("every = 5\nlevel = 2.0\nsample = \"soft\"\n"),
       "'sample' of [catch] is for designs without levels"},
  };
  for (const auto& each : bad)
    EXPECT_THAT([&] { (void)protocol_from(each.first); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(each.second)))
        << each.first;
}

TEST(CatchTrials, HaveAnExample) {
  const Protocol protocol = test::example_protocol("catch");
  EXPECT_EQ(protocol.tissues.front().samples.size(), 2U);
  EXPECT_EQ(catches_in(plan_of(protocol)).size(), 4U);
}

TEST(CatchTrials, OfAToleratedShareAreNotBelowIt) {
  EXPECT_FALSE((CatchTally{.right = 4, .trials = 5}.is_below(0.8)));
  EXPECT_TRUE((CatchTally{.right = 3, .trials = 5}.is_below(0.8)));
  EXPECT_FALSE((CatchTally{.right = 0, .trials = 0}.is_below(0.8))) << "of none nobody can say so";
}

}  // namespace
}  // namespace kerf::bench

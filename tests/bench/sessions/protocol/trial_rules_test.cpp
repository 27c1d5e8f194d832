#include "protocol/trial_rules.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

Protocol with_rules(const std::string& rules, const std::string& top = "design = \"abx\"\n") {
  return test::protocol_from(test::protocol_text(top, "[trial]\n" + rules));
}

TEST(TrialRules, OfAProtocolWithoutThemVoidNothing) {
  const TrialRules rules = test::protocol_from(test::protocol_text("design = \"abx\"")).rules;
  EXPECT_FALSE(rules.may_void());
  EXPECT_FALSE(rules.explore.is_asked());
  EXPECT_EQ(rules.states, StatesBetween::run_on);
  EXPECT_EQ(rules.start, TrialStart::at_once);
}

TEST(TrialRules, AreReadInAnyUnitOfTheirKind) {
  const TrialRules rules = with_rules(
                               "void = { fault = true, soft_start = true, limited_ticks = 50, "
                               "missed_deadlines = 3 }\nrepeats = 1\n"
                               "explore = { contact = { value = 500, unit = \"ms\" }, travel = { value = 20, "
                               "unit = \"mm\" }, strokes = 2,"
                               " force = { value = 300, unit = \"mN\" } }\nslip = true\nstates = "
                               "\"out-of-contact\"\nstart = \"key\"\n"
                               "pause = { value = 2, unit = \"s\" }\n")
                               .rules;
  EXPECT_TRUE(rules.fault);
  EXPECT_TRUE(rules.soft_start);
  EXPECT_EQ(rules.limited_ticks, 50U);
  EXPECT_EQ(rules.missed_deadlines, 3U);
  EXPECT_EQ(rules.repeats, 1U);
  EXPECT_DOUBLE_EQ(rules.explore.contact_s, 0.5);
  EXPECT_DOUBLE_EQ(rules.explore.travel_m, 0.02);
  EXPECT_DOUBLE_EQ(rules.explore.force_n, 0.3);
  EXPECT_EQ(rules.explore.strokes, 2U);
  EXPECT_TRUE(rules.slip);
  EXPECT_EQ(rules.states, StatesBetween::out_of_contact);
  EXPECT_EQ(rules.start, TrialStart::key);
  EXPECT_EQ(rules.pause_s, 2.0);
}

TEST(TrialRules, ThatCannotBeAreRefusedWithFileAndLine) {
  const auto refusal = [](const std::string& rules, const std::string& says,
                          const std::string& top = "design = \"abx\"\n") {
    EXPECT_THAT([&] { (void)with_rules(rules, top); }, ThrowsMessage<std::invalid_argument>(testing::AllOf(
                                                           HasSubstr("p.protocol.toml:"), HasSubstr(says))))
        << rules;
  };
  refusal("voided = 1", "voided");
  refusal("void = { faults = true }", "faults");
  refusal("void = { limited_ticks = -1 }", "'limited_ticks' is -1");
  refusal("void = { missed_deadlines = 1.5 }", "expected a whole number");
  refusal("repeats = 3", "nothing to repeat");
  refusal("slip = true\nrepeats = 21", "'repeats' is 21");
  refusal("explore = { }", "asks for nothing");
  refusal("explore = { travel = 5 }", "travel");
  refusal("explore = { travel = { value = 5, unit = \"N\" } }", "travel");
  refusal("explore = { contact = { value = 30, unit = \"s\" } }", "a slot has at most 20 s");
  refusal("explore = { contact = { value = 4, unit = \"s\" } }", "a slot has at most 4 s",
          "design = \"2ifc\"\nsignal = \"stiff\"\n");
  refusal("states = \"anew\"", "expected one of \"run-on\", \"reset\", \"out-of-contact\"");
  refusal("states = \"reset\"", "switching = \"through-zero\"", "design = \"preference\"\n");
  refusal("start = \"now\"", "expected one of \"at-once\"");
  refusal("pause = { value = -1, unit = \"s\" }", "pause");
}

TEST(VoidReasons, AreWordsAndBack) {
  std::vector<VoidReason> all;
  for (std::size_t i = 0; i < void_reasons; ++i) all.push_back(static_cast<VoidReason>(i));
  EXPECT_EQ(void_reasons_in(joined(all)), all);
  EXPECT_TRUE(void_reasons_in("").empty());
  EXPECT_THAT([] { (void)void_reasons_in("fault tired"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'tired'")));
}

// ---- In the order of a session

TEST(TrialSequence, GivesAVoidTrialAgainAtTheEndOfItsBlockWithTheSameSlots) {
  const Protocol protocol =
      test::protocol_from(test::protocol_text("design = \"preference\"\ntrials = 2\npractice = 2",
                                              std::string(test::two_tissues) + "[trial]\nslip = true\n"));
  const Plan plan = make_plans(protocol, 1, 5).front();
  TrialSequence sequence(protocol, plan);
  const std::size_t practice = 2;
  const std::size_t first = plan[practice].tissue;
  const auto of_first = static_cast<std::size_t>(std::ranges::count_if(
      plan, [&](const TrialPlan& each) { return !each.practice && each.tissue == first; }));
  sequence.answer(0);
  EXPECT_TRUE(sequence.repeat()) << "a trial of practice comes again in practice";
  EXPECT_TRUE(sequence.next()->practice);
  EXPECT_EQ(sequence.next()->slots, plan[1].slots);
  sequence.answer(0);
  const TrialPlan voided = *sequence.next();
  EXPECT_TRUE(sequence.repeat());
  for (std::size_t i = 1; i < of_first; ++i) {
    EXPECT_EQ(sequence.next()->slots, plan[practice + i].slots);
    sequence.answer(0);
  }
  const TrialPlan again = *sequence.next();
  EXPECT_EQ(again.tissue, first);
  EXPECT_EQ(again.pair, voided.pair);
  EXPECT_EQ(again.slots, voided.slots);
  sequence.answer(0);
  EXPECT_NE(sequence.next()->tissue, first) << "then the next tissue";
  EXPECT_EQ(sequence.planned(), plan.size());
  EXPECT_EQ(sequence.at_most(), plan.size() + 2);
}

TEST(TrialSequence, LeavesATrialOutThatIsVoidTooOften) {
  const Protocol protocol = with_rules("slip = true\nrepeats = 2\n", "design = \"abx\"\ntrials = 1\n");
  TrialSequence sequence(protocol, make_plans(protocol, 1, 5).front());
  EXPECT_TRUE(sequence.repeat());
  EXPECT_TRUE(sequence.repeat());
  EXPECT_FALSE(sequence.repeat()) << "the third time";
  EXPECT_FALSE(sequence.next());
  EXPECT_THROW((void)sequence.repeat(), std::invalid_argument);
}

TEST(TrialSequence, KeepsTheBalanceWhicheverTrialsAreVoid) {
  const Protocol protocol = with_rules("slip = true\nrepeats = 20\n", "design = \"abx\"\ntrials = 8\n");
  const Plan plan = make_plans(protocol, 1, 5).front();
  const auto sorted_slots = [](const Plan& trials) {
    std::vector<decltype(TrialPlan::slots)> slots;
    for (const TrialPlan& trial : trials) slots.push_back(trial.slots);
    std::ranges::sort(slots);
    return slots;
  };
  for (std::size_t step = 2; step < 6; ++step) {
    TrialSequence sequence(protocol, plan);
    Plan counted;
    while (const auto trial = sequence.next()) {
      if (sequence.answered() % step == 1) {
        (void)sequence.repeat();
      } else {
        counted.push_back(*trial);
        sequence.answer(0);
      }
    }
    EXPECT_EQ(sorted_slots(counted), sorted_slots(plan)) << "every " << step;
  }
}

TEST(TrialSequence, TellsTheRuleOfAStaircaseNothingOfAVoidTrial) {
  const Protocol protocol = test::protocol_from(test::level_text(
      "design = \"staircase\"\ntrials = 30",
      "vary = \"force\"\nstaircase = { start = 0.4, steps = [0.5, 0.25] }\n[trial]\nslip = true\n"));
  const Plan plan = make_plans(protocol, 1, 5).front();
  TrialSequence sequence(protocol, plan);
  const auto right = [&] { sequence.answer(sequence.next()->right(protocol)); };
  right();
  EXPECT_TRUE(sequence.repeat());
  EXPECT_DOUBLE_EQ(sequence.next()->level, 0.4) << "one right answer so far";
  right();
  EXPECT_LT(sequence.next()->level, 0.4);
  const double level = sequence.next()->level;
  EXPECT_TRUE(sequence.repeat());
  EXPECT_EQ(sequence.next()->level, level);
  std::vector<decltype(TrialPlan::slots)> given;
  for (int i = 0; i < 8; ++i) {
    given.push_back(sequence.next()->slots);
    right();
  }
  const auto lead = std::ranges::count_if(given, [](const auto& slots) { return slots[0] == 0; }) +
                    (plan[0].slots[0] == 0 ? 1 : 0) + (plan[2].slots[0] == 0 ? 1 : 0);
  EXPECT_EQ(lead, 5) << "of the ten that count the standard comes first in five";
}

TEST(TrialSequence, PractisesUntilItsCriterionAndNoLonger) {
  const Protocol protocol = test::protocol_from(test::protocol_text(
      "design = \"abx\"\ntrials = 4\npractice = 10\npractice_until = { right = 3, of = 4 }\n"));
  TrialSequence sequence(protocol, make_plans(protocol, 1, 5).front());
  const auto give = [&](bool is_right) {
    const std::size_t right = sequence.next()->right(protocol);
    sequence.answer(is_right ? right : 1 - right);
  };
  for (const bool is_right : {true, false, false, true, true}) give(is_right);
  EXPECT_FALSE(sequence.practised()) << "two of the last four";
  EXPECT_TRUE(sequence.next()->practice);
  give(true);
  EXPECT_EQ(sequence.practised(), true) << "three of the last four";
  EXPECT_FALSE(sequence.next()->practice);
  EXPECT_EQ(sequence.planned(), 10U);
  EXPECT_EQ(sequence.answered(), 6U);
  for (int i = 0; i < 4; ++i) give(false);
  EXPECT_FALSE(sequence.next());
}

TEST(TrialSequence, GoesOnOrEndsWherePracticeDoesNotComeToItsCriterion) {
  for (const bool ends : {false, true}) {
    const Protocol protocol = test::protocol_from(
        test::protocol_text(fmt::format("design = \"abx\"\ntrials = 4\npractice = 3\npractice_until = {{ "
                                        "right = 3, of = 3, otherwise = \"{}\" }}\n",
                                        ends ? "end" : "go-on")));
    TrialSequence sequence(protocol, make_plans(protocol, 1, 5).front());
    for (int i = 0; i < 3; ++i) sequence.answer(1 - sequence.next()->right(protocol));
    EXPECT_EQ(sequence.practised(), false);
    EXPECT_EQ(sequence.next().has_value(), !ends);
  }
}

TEST(PracticeCriterion, ThatCannotBeIsRefused) {
  const auto refusal = [](const std::string& top, const std::string& says) {
    EXPECT_THAT([&] { (void)test::protocol_from(test::protocol_text(top)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(says)));
  };
  refusal("design = \"abx\"\npractice = 5\npractice_until = { right = 4 }", "needs 'of'");
  refusal("design = \"abx\"\npractice = 5\npractice_until = { right = 6, of = 6 }", "'of' is 6");
  refusal("design = \"abx\"\npractice = 5\npractice_until = { right = 5, of = 4 }", "'right' is 5");
  refusal("design = \"preference\"\npractice = 5\npractice_until = { right = 4, of = 5 }",
          "an answer is right");
}

TEST(TrialSequence, WithVoidTrialsIsResumedByThem) {
  const Protocol protocol = with_rules("slip = true\n", "design = \"abx\"\ntrials = 12\npractice = 2\n");
  const Plan plan = make_plans(protocol, 1, 5).front();
  std::vector<bool> voids;
  TrialSequence sequence(protocol, plan);
  while (const auto trial = sequence.next()) {
    TrialSequence resumed(protocol, plan);
    for (const bool is_void : voids) {
      if (is_void) {
        (void)resumed.repeat();
      } else {
        resumed.answer(0);
      }
    }
    ASSERT_TRUE(resumed.next());
    EXPECT_EQ(resumed.next()->slots, trial->slots);
    EXPECT_EQ(resumed.at_most(), sequence.at_most());
    voids.push_back(voids.size() % 3 == 1);
    if (voids.back()) {
      (void)sequence.repeat();
    } else {
      sequence.answer(0);
    }
  }
  EXPECT_GT(voids.size(), 16U);
}

}  // namespace
}  // namespace kerf::bench

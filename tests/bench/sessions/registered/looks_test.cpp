#include "registered/looks.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "registered/assignment.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::string> first_of_all(std::size_t count) {
  std::vector<std::string> codes;
  for (std::size_t i = 1; i <= count; ++i) codes.push_back(code_of(i, 12));
  return codes;
}

/// Of twelve participants so many are through.
ExperimentState state_with(std::size_t through, const std::string& stopping) {
  ExperimentState state;
  state.experiment = parse_experiment(
      "name = \"x\"\nprotocol = \"p\"\n[participants]\ntarget = 12\n"
      "[analysis]\nstopping = { " +
          stopping + " }\n",
      "e.toml");
  for (std::size_t i = 1; i <= 12; ++i) {
    state.participants.push_back({.code = code_of(i, 12), .number = i, .sessions = {{.visit = 1}}});
    state.participants.back().sessions[0].finished = i <= through;
  }
  return state;
}

const std::string pocock = "rule = \"alpha-spending\", spending = \"pocock\", looks = [6, 9]";

Look look_of(const ExperimentState& state, std::size_t through, const std::string& reason = "") {
  return look_at(state, {.participants = first_of_all(through), .reason = reason, .two_sided = false});
}

TEST(Look, IsRefusedBeforeTheEndOfAFixedStudyUnlessSomebodySaysWhy) {
  const ExperimentState state = state_with(7, "rule = \"fixed\"");
  EXPECT_THAT([&] { (void)look_of(state, 7); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("7 of 12 participants are through")));
  EXPECT_THROW((void)look_of(state, 7, "  "), std::invalid_argument);
  const Look look = look_of(state, 7, "the ethics board asked");
  EXPECT_FALSE(look.is_paid);
  EXPECT_EQ(look.nominal, 0.0) << "and decides nothing";
  EXPECT_THAT([&] { (void)look_of(state, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no participant is through")));
}

TEST(Look, AtTheEndHasAllOfAlpha) {
  const Look look = look_of(state_with(12, "rule = \"fixed\""), 12);
  EXPECT_TRUE(look.is_last);
  EXPECT_TRUE(look.is_paid);
  EXPECT_DOUBLE_EQ(look.nominal, 0.05);
}

TEST(Look, IsPaidBySpendingWhereverItIsTaken) {
  ExperimentState state = state_with(7, pocock);
  const Look first = look_of(state, 7);
  EXPECT_TRUE(first.is_paid);
  EXPECT_FALSE(first.is_planned);
  EXPECT_NEAR(first.spent, 0.05 * std::log(1.0 + (std::exp(1.0) - 1.0) * 7.0 / 12.0), 1e-12);
  EXPECT_NEAR(first.nominal, first.spent, 1e-9) << "the first look spends all that it may at once";
  state.looks.push_back({.time = "t", .participants = first.participants, .paid = true, .reason = ""});
  EXPECT_FALSE(look_of(state, 7).is_new) << "the same participants again are the same look";
  EXPECT_DOUBLE_EQ(look_of(state, 7).nominal, first.nominal);
  ExperimentState later = state_with(12, pocock);
  later.looks = state.looks;
  const Look last = look_of(later, 12);
  EXPECT_EQ(last.number, 2U);
  EXPECT_DOUBLE_EQ(last.spent, 0.05);
  EXPECT_LT(last.nominal, 0.05);
}

TEST(Look, WithNobodyMoreIsPaidByNothing) {
  ExperimentState state = state_with(6, pocock);
  state.looks.push_back(
      {.time = "t", .participants = {"S02", "S03", "S04", "S05", "S06", "S07"}, .paid = true, .reason = ""});
  const Look look = look_of(state, 6);
  EXPECT_TRUE(look.is_new);
  EXPECT_FALSE(look.is_paid);
  EXPECT_GT(look.spent, 0.0) << "what was spent stays spent";
}

TEST(Study, IsOverWhenEveryOrderHasSomebodyWhoIsThroughOrIsNotReplaced) {
  ExperimentState state = state_with(11, "rule = \"fixed\"");
  EXPECT_FALSE(state.is_over());
  state.participants[11].dropped = true;
  EXPECT_FALSE(state.is_over()) << "somebody may take the place";
  state.experiment.participants.replace = ReplacementRule::never;
  EXPECT_TRUE(state.is_over());
  state.experiment.participants.replace = ReplacementRule::dropped;
  state.participants[11].replaced_by = "S13";
  state.participants.push_back({.code = "S13", .number = 12, .replaces = "S12", .sessions = {{.visit = 1}}});
  EXPECT_FALSE(state.is_over());
  state.participants[12].sessions[0].finished = true;
  EXPECT_TRUE(state.is_over());
  const FlowCounts flow = flow_of(state).front();
  EXPECT_EQ(flow.assigned, 13U);
  EXPECT_EQ(flow.completed, 12U);
  EXPECT_EQ(flow.dropped, 1U);
  EXPECT_EQ(flow.replaced, 1U);
  EXPECT_EQ(flow.analysed, 12U);
}

TEST(Replacement, TakesAPlaceThatIsFreeUnderACodeThatIsFree) {
  ExperimentState state = state_with(3, "rule = \"fixed\"");
  const auto expect_refused = [&](const std::string& leaving, const std::string& code,
                                  const std::string& why) {
    EXPECT_THAT([&] { (void)replacement_code(state, leaving, code); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  expect_refused("S99", "", "there is no participant S99");
  expect_refused("S04", "", "S04 takes part");
  state.participants[3].dropped = true;
  EXPECT_EQ(replacement_code(state, "S04", ""), "S13");
  EXPECT_EQ(replacement_code(state, "S04", "Anna"), "Anna");
  expect_refused("S04", "S05", "the code S05 is taken");
  state.participants[3].replaced_by = "S13";
  expect_refused("S04", "", "replaced by S13 already");
  state.participants[4].excluded = true;
  expect_refused("S05", "", "the registered rule is replace = \"dropped\"");
}

}  // namespace
}  // namespace kerf::bench

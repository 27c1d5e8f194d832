#include <cmath>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "protocol/plan.h"
#include "protocol/protocol.h"

namespace kerf::bench {
namespace {

using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

void expect_number_refusal(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { (void)protocol_from(text); }, ThrowsMessage<std::invalid_argument>(HasSubstr(message)))
      << text;
}

const std::string rated = "design = \"rating\"\nends = [\"not at all\", \"very\"]\n";

TEST(NumberProtocol, OfMagnitudesPlaysOneSampleOrAStandardAhead) {
  const Protocol free = protocol_from(protocol_text("design = \"magnitude\""));
  EXPECT_EQ(slots_of(free), 1U);
  EXPECT_EQ(free.presentation, Presentation::sequence);
  EXPECT_THAT(pairs_of(free, 0), ElementsAre(ElementsAre(0, 0), ElementsAre(1, 1)));
  EXPECT_EQ(choices_of(free), 1U);
  EXPECT_TRUE(written_numbers_of(free)->holds(12.5));
  EXPECT_FALSE(written_numbers_of(free)->holds(0.0));

  const Protocol against =
      protocol_from(protocol_text("design = \"magnitude\"\nstandard = \"stiff\"\nmodulus = 10"));
  EXPECT_EQ(slots_of(against), 2U);
  EXPECT_THAT(pairs_of(against, 0), ElementsAre(ElementsAre(1, 0), ElementsAre(1, 1)));
  const Plan plan = make_plans(against, 1, 3).front();
  for (const TrialPlan& trial : plan) EXPECT_EQ(trial.slots[1], 1U) << "the sample comes after the standard";
}

TEST(NumberProtocol, OfMagnitudesTakesLevels) {
  const Protocol protocol = protocol_from(
      level_text("design = \"magnitude\"\ntrials = 3", "vary = \"force\"\nlevels = [-0.5, 0, 1, 3]"));
  EXPECT_THAT(protocol.scale.levels, ElementsAre(-0.5, 0.0, 1.0, 3.0));
  const Plan plan = make_plans(protocol, 1, 1).front();
  EXPECT_EQ(plan.size(), 12U);
  for (const TrialPlan& trial : plan) EXPECT_FALSE(std::isnan(trial.level));
}

TEST(NumberProtocol, OfRatingsHasStepsOrALine) {
  const Protocol line = protocol_from(protocol_text(rated));
  EXPECT_TRUE(written_numbers_of(line)->holds(0.0));
  EXPECT_FALSE(written_numbers_of(line)->holds(100.5));
  const Protocol steps = protocol_from(protocol_text(rated + "points = 5"));
  EXPECT_FALSE(written_numbers_of(steps));
  EXPECT_THAT(choice_labels_of(steps), ElementsAre("not at all", "2", "3", "4", "very"));
  EXPECT_EQ(number_of_answer(steps, 4, 0.0), 5.0);
  EXPECT_EQ(number_of_answer(line, 0, 37.0), 37.0);
}

TEST(NumberProtocol, RefusesWhatCannotBe) {
  const std::string magnitude = "design = \"magnitude\"\n";
  expect_number_refusal(protocol_text(magnitude + "modulus = 10"), "'modulus' is the number of a standard");
  expect_number_refusal(protocol_text(magnitude + "standard = \"soft\""),
                        "needs its number, such as modulus = 10");
  expect_number_refusal(protocol_text(magnitude + "standard = \"x\"\nmodulus = 10"), "there is no sample");
  expect_number_refusal(protocol_text(magnitude + "standard = \"soft\"\nmodulus = 0"), "'modulus' is 0");
  expect_number_refusal(protocol_text(magnitude + "points = 7"), "'points' is for the design \"rating\"");
  expect_number_refusal(protocol_text(magnitude + "presentation = \"free\""), "leave 'presentation' out");
  expect_number_refusal(protocol_text(magnitude + "practice = 2\nfeedback = true"), "no number is right");
  expect_number_refusal(protocol_text(magnitude + "practice = 2\npractice_until = { right = 1, of = 2 }"),
                        "an answer is right");
  expect_number_refusal(level_text("design = \"magnitude\"", "vary = \"force\"\nlevels = [1]"),
                        "one level has no exponent");
  expect_number_refusal(level_text("design = \"magnitude\"", "vary = \"force\""), "[scale] needs 'levels'");
  expect_number_refusal(protocol_text("design = \"rating\""), "needs 'ends'");
  expect_number_refusal(protocol_text("design = \"rating\"\nends = [\"a\"]"), "array of two texts");
  expect_number_refusal(protocol_text("design = \"rating\"\nends = [\"a\", \"a\"]"), "both ends are 'a'");
  expect_number_refusal(protocol_text(rated + "points = 2"), "'points' is 2");
  expect_number_refusal(protocol_text(rated + "modulus = 10"), "'modulus' is for the design \"magnitude\"");
  expect_number_refusal(protocol_text("design = \"abx\"\nends = [\"a\", \"b\"]"), "'ends' is for the design");
  expect_number_refusal(protocol_text(rated, "[scale]\nvary = \"force\"\nlevels = [1, 2]"), "[scale] is for");
}

TEST(NumberProtocol, NeedsTheStandardInEveryTissue) {
  expect_number_refusal(
      protocol_text("design = \"magnitude\"\nstandard = \"stiff\"\nmodulus = 10", test::two_tissues),
      "tissue 'skin' is without the standard 'stiff'");
}

}  // namespace
}  // namespace kerf::bench

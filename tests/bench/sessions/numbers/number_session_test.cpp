#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/session/blind_run.h"
#include "sealed/session_export.h"
#include "sealed/trials/trial_bytes.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::HasSubstr;

const std::string brief =
    "trials = 3\ninterval = { value = 400, unit = \"ms\" }\ngap = { value = 100, unit = \"ms\" }\n"
    "ramp = { value = 50, unit = \"ms\" }\n";

/// Goes on, and writes the same number whenever it may, after one that cannot be.
test::ScriptedSubject::Script writes(double impossible, double number) {
  return [=, refused = false](const SubjectView& view) mutable -> std::optional<SubjectAction> {
    using Kind = SubjectAction::Kind;
    if (view.may_go_on) return SubjectAction{.kind = Kind::go_on};
    if (!view.may_answer) return std::nullopt;
    refused = !refused;
    return SubjectAction{.kind = Kind::answer, .number = refused ? impossible : number};
  };
}

TEST(NumberSession, KeepsMagnitudesAndTheForcesThatTheyAreOf) {
  test::BlindRun session(protocol_from(
      protocol_text("design = \"magnitude\"\nstandard = \"soft\"\nmodulus = 10\npractice = 1\n" + brief)));
  test::ScriptedSubject subject(writes(0.0, 12.5));
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 7U);
  const Study study = study_of(std::vector<const SessionStore*>{&store});
  EXPECT_FALSE(study.task);
  EXPECT_EQ(study.numbers.modulus, 10.0);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(store.trials()[i].number, 12.5);
    EXPECT_EQ(study.judgements[i].estimate, 12.5);
    EXPECT_EQ(study.judgements[i].practice, i == 0);
    std::set<int> slots;
    for (const TraceRow& tick : store.trial(i).trace) slots.insert(tick.slot);
    EXPECT_EQ(slots, (std::set<int>{0, 1, 255}));
  }
  EXPECT_TRUE(study.felt.empty());
}

TEST(NumberSession, OfLevelsKnowsTheirIntensity) {
  test::BlindRun session(
      protocol_from(level_text("design = \"magnitude\"\n" + brief, "vary = \"force\"\nlevels = [-0.5, 1]")));
  test::ScriptedSubject subject(writes(-1.0, 3.0));
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  for (const Judgement& each : study_of(std::vector<const SessionStore*>{&store}).judgements)
    EXPECT_EQ(each.intensity, 1.0 + each.level);
}

TEST(NumberSession, RehearsesEveryKindOfScale) {
  const std::string rated = "design = \"rating\"\nends = [\"not at all\", \"very\"]\n";
  for (const std::string& design : {std::string("design = \"magnitude\"\n"), rated, rated + "points = 5\n"}) {
    test::BlindRun session(protocol_from(protocol_text(design + brief)));
    RehearsalSubject subject(1);
    EXPECT_EQ(session.run(subject).end, SessionEnd::finished) << design;
    const SessionStore store = session.read();
    std::set<double> numbers;
    for (const Judgement& each : study_of(std::vector<const SessionStore*>{&store}).judgements)
      numbers.insert(each.estimate);
    EXPECT_GT(numbers.size(), 2U) << design;
    EXPECT_FALSE(numbers.contains(0.0) && design.find("points") != std::string::npos);
    const test::TemporaryFolder folder;
    export_session(store, folder / "out", false);
    EXPECT_THAT(test::read_text(folder / "out" / "trials.csv"), HasSubstr(",void,catch,estimate\n"));
  }
}

TEST(NumberSession, AsksOfTheFirstWhatItsNumberIs) {
  test::BlindRun session(
      protocol_from(protocol_text("design = \"magnitude\"\nstandard = \"soft\"\nmodulus = 10\n" + brief)));
  SessionStore store = session.store(SessionStore::Purpose::run);
  std::string asked;
  bool has_number = false;
  test::ScriptedSubject subject([&](const SubjectView& view) -> std::optional<SubjectAction> {
    if (view.stage == SessionStage::trial) {
      asked = view.text;
      has_number = view.number.has_value() && view.number->ends.empty();
      return SubjectAction{.kind = SubjectAction::Kind::quit};
    }
    return SubjectAction{.kind = SubjectAction::Kind::go_on};
  });
  (void)test::BlindRun::run(store, subject);
  EXPECT_THAT(asked, HasSubstr("The first is 10: which number is the second?"));
  EXPECT_TRUE(has_number);
}

TEST(NumberSession, HidesANumberInAsManyBytesAsNone) {
  RecordedTrial trial;
  const std::size_t without = trial_bytes(trial).size();
  trial.number = 123456.789;
  EXPECT_EQ(trial_bytes(trial).size(), without);
  EXPECT_EQ(trial_from(trial_bytes(trial), TraceToo::no).number, 123456.789);
}

}  // namespace
}  // namespace kerf::bench

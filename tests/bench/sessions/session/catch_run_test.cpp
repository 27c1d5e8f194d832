// Sessions with catch trials, from the first force to the analysis.

#include <algorithm>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_json.h"
#include "answers/analysis.h"
#include "answers/answers_table.h"
#include "bench/sessions/session/blind_run.h"
#include "sealed/session_export.h"
#include "sealed/trials/session_quality.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

Protocol caught_protocol(const std::string& more = "") {
  return test::protocol_from(test::protocol_text(
      "design = \"abx\"\ntrials = 6\n",
      "[[sample]]\nname = \"third\"\nlaw = \"third.law.toml\"\n[catch]\nevery = 3\nsample = \"third\"\n" +
          more));
}

std::size_t catches_of_all(const SessionStore& store) {
  return static_cast<std::size_t>(
      std::ranges::count_if(store.trials(), [](const RecordedTrial& trial) { return trial.what.is_catch; }));
}

TEST(CatchRun, KeepsCatchTrialsApartFromWhatIsAnalysed) {
  test::BlindRun session(caught_protocol());
  RehearsalSubject subject(1);
  ASSERT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 8U);
  EXPECT_EQ(catches_of_all(store), 2U);
  const Study study = study_of({&store});
  EXPECT_EQ(study.felt.size(), 6 * slots_of(study.design));
  EXPECT_EQ(study.explored.size(), 6 * slots_of(study.design))
      << "a catch trial tells nothing of the samples";
  const Analysis found = analyse(study, {.bootstrap = 0});
  EXPECT_EQ(found.trials, 6U);
  EXPECT_EQ(found.quality.known, 6U);
  ASSERT_EQ(found.catches.size(), 1U);
  EXPECT_EQ(found.catches[0].tally.trials, 2U);
  const auto json = analysis_as_json(found);
  EXPECT_EQ(json["catch"][0]["subject"], "S01");
  EXPECT_EQ(json["catch"][0]["trials"], 2);
  EXPECT_THAT(summary_lines(found), testing::Contains(HasSubstr("catch trials, which are in no test: S01 ")));
}

TEST(CatchRun, HasItsTablesSayWhichTrialsTheyWere) {
  test::BlindRun session(caught_protocol());
  RehearsalSubject subject(1);
  (void)session.run(subject);
  const SessionStore store = session.read();
  const Study study = study_of({&store});
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(analyse(again, {.bootstrap = 0}).trials, 6U) << "the table of all answers says it";
  EXPECT_EQ(catches_by_subject(again).front().tally.right, catches_by_subject(study).front().tally.right);
  const test::TemporaryFolder folder;
  export_session(store, folder / "open", false);
  const std::string table = test::read_text(folder / "open/trials.csv");
  EXPECT_THAT(table, HasSubstr(",void,catch\n"));
  EXPECT_EQ(analyse(parse_answers(table, "trials.csv"), {.bootstrap = 0}).trials, 6U);
}

// Who looks on may know when all is over, but not which of the trials was one.
TEST(CatchRun, TellsNobodyWhichTrialWasOneWhileItRuns) {
  test::BlindRun session(caught_protocol("[trial]\nvoid = { fault = true }\n"));
  SessionStore running = session.store(SessionStore::Purpose::run);
  RehearsalSubject inner(1);
  std::map<std::size_t, SessionQuality> seen;
  test::ScriptedSubject subject([&](const SubjectView& view) {
    if (!seen.contains(running.trials().size())) seen[running.trials().size()] = session_quality(running);
    inner.show(view);
    return inner.next();
  });
  ASSERT_EQ(test::BlindRun::run(running, subject).end, SessionEnd::finished);
  ASSERT_EQ(seen.size(), 8U);
  for (const auto& [given, quality] : seen) {
    EXPECT_EQ(quality.counts.counted, given) << "catch trials among them";
    EXPECT_EQ(quality.catches.has_value(), false);
    EXPECT_THAT(in_words(quality.counts), Not(HasSubstr("catch")));
  }
  const SessionQuality after = session_quality(running);
  ASSERT_TRUE(after.catches.has_value());
  EXPECT_EQ(after.catches->trials, 2U);
  EXPECT_THAT(in_words(after), HasSubstr(" of 2 catch trials right"));
  EXPECT_EQ(to_json(after)["catch"]["trials"], 2);
}

// A sample without force, or of another strength, must not be refused for what no hand could do in it.
TEST(CatchRun, AsksForNoExplorationInACatchTrial) {
  test::BlindRun session(
      caught_protocol("[trial]\nexplore = { force = { value = 90, unit = \"N\" } }\nrepeats = "
                      "0\n"));
  RehearsalSubject subject(1);
  test::ScriptedSubject patient([&](const SubjectView& view) {
    subject.show(view);
    return subject.next();
  });
  ASSERT_EQ(session.run(patient).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 8U);
  for (const RecordedTrial& trial : store.trials()) EXPECT_EQ(trial.is_void(), !trial.what.is_catch);
}

TEST(CatchRun, ShowsTheSubjectNothingOfThem) {
  test::BlindRun with(caught_protocol());
  test::WatchingSubject subject(1);
  ASSERT_EQ(with.run(subject).end, SessionEnd::finished);
  for (const std::string& view : subject.seen) EXPECT_THAT(view, Not(HasSubstr("catch")));
  EXPECT_THAT(subject.seen, testing::Contains(HasSubstr("Trial 8 of 8")));
}

}  // namespace
}  // namespace kerf::bench

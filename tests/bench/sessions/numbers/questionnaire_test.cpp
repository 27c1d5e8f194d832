#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answers/analysis.h"
#include "bench/sessions/session/blind_run.h"
#include "protocol/questionnaire/questionnaire_table.h"
#include "sealed/session_export.h"

namespace kerf::bench {
namespace {

using test::protocol_from;
using test::protocol_text;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string short_trials =
    "design = \"preference\"\npresentation = \"sequence\"\ntrials = 1\npractice = 1\n"
    "interval = { value = 400, unit = \"ms\" }\ngap = { value = 100, unit = \"ms\" }\n"
    "ramp = { value = 50, unit = \"ms\" }\n";
const std::string load_index = "[questionnaire]\nuse = \"nasa-tlx\"\n";

TEST(Questionnaire, RefusesWhatCannotBe) {
  const auto refused = [](const std::string& table, const std::string& message) {
    EXPECT_THAT([&] { (void)protocol_from(protocol_text(short_trials, table)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  };
  refused("[questionnaire]\n", "needs use = \"nasa-tlx\" or one [[questionnaire.item]]");
  refused("[questionnaire]\nuse = \"sus\"\n", "expected one of \"nasa-tlx\"");
  refused(load_index + "after = \"trial\"\n", "expected one of \"block\", \"end\"");
  const std::string item = "[[questionnaire.item]]\nname = \"real\"\nquestion = \"How real?\"\n";
  refused(item, "needs 'ends'");
  refused(item + "ends = [\"a\", \"b\"]\n" + item + "ends = [\"a\", \"b\"]\n", "two items named 'real'");
}

TEST(Questionnaire, IsFilledInAfterEveryBlockUnderTheSeal) {
  test::BlindRun session(protocol_from(protocol_text(short_trials, test::two_tissues + load_index)));
  RehearsalSubject subject(1);
  EXPECT_EQ(session.run(subject).end, SessionEnd::finished);
  const SessionStore store = session.read();
  ASSERT_EQ(store.questionnaires().size(), 2U);
  EXPECT_NE(store.questionnaires()[0].tissue, store.questionnaires()[1].tissue);
  const std::size_t last = store.trials().size() - 1;
  EXPECT_EQ(store.questionnaires()[1].tissue, store.trial(last).what.tissue);
  for (const FilledQuestionnaire& filled : store.questionnaires()) {
    ASSERT_EQ(filled.scores.size(), 6U);
    for (const double score : filled.scores) EXPECT_EQ(std::remainder(score, 5.0), 0.0);
  }
  for (const schema::SessionEntry& entry : store.session().entries) {
    if (entry.kind != "questionnaire") continue;
    EXPECT_THAT(entry.text, testing::Not(testing::AnyOf(HasSubstr("liver"), HasSubstr("skin"))));
  }
  EXPECT_EQ(study_of(std::vector<const SessionStore*>{&store}).questionnaires.size(), 2U);
}

TEST(Questionnaire, IsAskedAgainWhereTheSubjectLeftIt) {
  test::BlindRun session(protocol_from(protocol_text(short_trials, load_index + "after = \"end\"\n")));
  RehearsalSubject chance(1);
  std::size_t items = 0;
  test::ScriptedSubject leaves([&](const SubjectView& view) -> std::optional<SubjectAction> {
    using Kind = SubjectAction::Kind;
    if (view.may_go_on) return SubjectAction{.kind = Kind::go_on};
    if (!view.may_answer) return std::nullopt;
    if (view.stage != SessionStage::questionnaire) return SubjectAction{.kind = Kind::answer, .slot = 0};
    if (++items == 3) return SubjectAction{.kind = Kind::quit};
    return SubjectAction{.kind = Kind::answer, .number = 35.0};
  });
  EXPECT_EQ(session.run(leaves).end, SessionEnd::quit);
  EXPECT_TRUE(session.read().questionnaires().empty());
  EXPECT_EQ(session.run(chance).end, SessionEnd::finished);
  EXPECT_EQ(session.read().questionnaires().size(), 1U);
}

TEST(Questionnaire, HasMeansOverSubjects) {
  Study study{.name = "made up", .samples = {"a", "b"}, .judgements = {}};
  study.questionnaire.items = {{"one", "?", {"low", "high"}}, {"two", "?", {"low", "high"}}};
  study.questionnaires = {{.subject = "A", .scores = {10, 30}, .at = {}},
                          {.subject = "B", .scores = {20, 80}, .at = {}},
                          {.subject = "B", .scores = {40, 80}, .at = {}}};
  const auto scores = questionnaire_scores(study, 0.95);
  ASSERT_EQ(scores.size(), 3U);
  EXPECT_EQ(scores[0].mean, 20.0);  // of A 10, of B 30
  EXPECT_EQ(scores[2].item, "overall");
  EXPECT_EQ(scores[2].mean, 37.5);  // of A 20, of B 55
  EXPECT_EQ(scores[2].subjects, 2U);
  // Student's t of one degree of freedom, 12.7062, times 35 / 2.
  EXPECT_NEAR(scores[2].over_subjects->interval.upper, 37.5 + 12.7062 * 17.5, 1e-3);
  EXPECT_THAT(questionnaire_csv(study), HasSubstr("B,1,,two,80,\n"));
}

TEST(Questionnaire, IsATableOfAnOpenedSession) {
  const auto items = [](const std::string& after) {
    return fmt::format(
        "[questionnaire]\nafter = \"{}\"\n"
        "[[questionnaire.item]]\nname = \"real, or not\"\nquestion = \"How real?\"\nends = [\"a\", \"b\"]\n"
        "[[questionnaire.item]]\nname = \"tired\"\nquestion = \"How tired?\"\nends = [\"a\", \"b\"]\n",
        after);
  };
  for (const std::string after : {"block", "end"}) {
    test::BlindRun session(protocol_from(protocol_text(short_trials, test::two_tissues + items(after))));
    double given = 0.0;
    test::ScriptedSubject subject([&](const SubjectView& view) -> std::optional<SubjectAction> {
      using Kind = SubjectAction::Kind;
      if (view.may_go_on) return SubjectAction{.kind = Kind::go_on};
      if (!view.may_answer) return std::nullopt;
      if (view.stage != SessionStage::questionnaire) return SubjectAction{.kind = Kind::answer, .slot = 0};
      return SubjectAction{.kind = Kind::answer, .number = given += 5.0};
    });
    ASSERT_EQ(session.run(subject).end, SessionEnd::finished);
    const SessionStore store = session.read();
    const test::TemporaryFolder folder;
    export_session(store, folder / "open", false);
    std::istringstream table(test::read_text(folder / "open" / "questionnaire.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(table, line);) lines.push_back(line);
    std::vector<std::string> expected{"subject,number,tissue,item,score,at"};
    double score = 0.0;
    for (const FilledQuestionnaire& filled : store.questionnaires()) {
      const std::string tissue = after == "block" ? store.protocol().tissues[filled.tissue].name : "";
      for (const char* const item : {"\"real, or not\"", "tired"})
        expected.push_back(fmt::format("S01,1,{},{},{},{}", tissue, item, score += 5.0, filled.at));
    }
    ASSERT_EQ(expected.size(), after == "block" ? 5U : 3U);
    ASSERT_GT(lines.size(), 2U);
    EXPECT_EQ(lines[0], "# name = \"two laws\"");
    EXPECT_THAT(lines[1], HasSubstr("# score: from 0, the first of the item's ends, to 100; tissue: "));
    EXPECT_THAT(std::vector(lines.begin() + 2, lines.end()), testing::ElementsAreArray(expected));
    EXPECT_THAT([&] { export_session(store, folder / "open", false); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("--force replaces it")));
    std::filesystem::remove(folder / "open" / "trials.csv");
    std::filesystem::remove(folder / "open" / "slots.csv");
    for (std::size_t i = 0; i < store.trials().size(); ++i)
      std::filesystem::remove(folder / "open" / fmt::format("trial-{:03}.h5", i + 1));
    EXPECT_THROW(export_session(store, folder / "open", false), std::invalid_argument)
        << "the questionnaires alone are not written over";
  }
}

}  // namespace
}  // namespace kerf::bench

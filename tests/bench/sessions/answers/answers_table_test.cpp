#include "answers/answers_table.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answers/analysis.h"
#include "bench/sessions/answers/studies.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

std::string refusal(std::string_view text, std::optional<Design> design = {}) {
  try {
    (void)parse_answers(text, "a.csv", design);
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "it was not refused";
}

TEST(ATableOfPreferences, NamesItsTwoSamples) {
  const Study study =
      parse_answers("subject,tissue,preferred\n1,liver,b\n1,skin,a\n2,liver,b\n", "x/what.csv");
  EXPECT_EQ(study.name, "what");
  EXPECT_EQ(study.design, Design::preference);
  EXPECT_EQ(study.samples, (std::vector<std::string>{"b", "a"}));
  EXPECT_FALSE(study.slots_known);
  ASSERT_EQ(study.judgements.size(), 3U);
  EXPECT_EQ(analyse(study).preferred, (std::vector<std::size_t>{2, 1}));
}

TEST(ATableOfPreferences, AmongManySaysWhichWereCompared) {
  const Study study = parse_answers("subject;first;second;preferred\n1;a;b;a\n1;b;c;c\n1;a;c;a\n", "a.csv");
  EXPECT_EQ(study.samples.size(), 3U);
  EXPECT_EQ(analyse(study).preferred, (std::vector<std::size_t>{2, 0, 1}));
}

TEST(ATableOfRightAnswers, NeedsADesign) {
  const char* text = "subject,correct\n1,1\n1,0\n1,yes\n2,wrong\n";
  EXPECT_THAT(refusal(text), HasSubstr("a.csv:1: the table does not say what was asked"));
  const Study study = parse_answers(text, "a.csv", Design::abx);
  EXPECT_EQ(study.task->decision, psychophysics::Decision::abx_independent);
  EXPECT_EQ(analyse(study).all->count.successes, 2);
}

TEST(ATableOfRightAnswers, SaysItsDesignAndTaskInComments) {
  const Study study = parse_answers(
      "# name = \"odd ones\"\n# design = \"3ifc\"\n# task = \"oddity\"\nsubject,correct\n1,1\n", "a.csv");
  EXPECT_EQ(study.name, "odd ones");
  EXPECT_EQ(study.design, Design::three_interval);
  EXPECT_EQ(study.task->decision, psychophysics::Decision::oddity);
}

TEST(ATableOfLevels, KnowsTheLevelsThatWereShown) {
  const Study study = parse_answers("subject,level,correct\n1,0.2,1\n1,0.1,0\n1,0.2,1\n", "a.csv");
  EXPECT_EQ(study.design, Design::constant);
  EXPECT_EQ(study.scale.levels, (std::vector<double>{0.1, 0.2}));
  EXPECT_TRUE(study.task);
}

// Right below the standard is to name the standard, not the comparison.
TEST(ATableOfLevels, UnderADesignWithoutThemIsToldSo) {
  const char* const rows = "subject,level,correct\n1,0.2,1\n1,0.1,0\n";
  EXPECT_THAT(parse_answers(std::string("# design = \"2ifc\"\n") + rows, "a.csv").remarks,
              testing::ElementsAre(HasSubstr("the column 'level' is not looked at")));
  EXPECT_THAT(parse_answers(rows, "a.csv").remarks, testing::IsEmpty());
}

TEST(ATableOfLevelsOnBothSides, TakesRightnessAsWellAsWhatWasNamed) {
  const Study named = parse_answers("subject,level,comparison\n1,-0.1,0\n1,0.1,1\n1,0,1\n", "a.csv");
  EXPECT_FALSE(named.task);
  EXPECT_FALSE(named.judgements[0].is_right());
  EXPECT_TRUE(named.judgements[2].is_right());
  const Study right = parse_answers("subject,level,correct\n1,-0.1,1\n1,0.1,1\n", "a.csv");
  EXPECT_FALSE(right.judgements[0].is_right());
  EXPECT_TRUE(right.judgements[1].is_right());
}

TEST(KerfsOwnTable, HasSlotsAndPractice) {
  const Study study = parse_answers(
      "# design = \"abx\"\n"
      "subject,number,trial,practice,tissue,first,second,level,slots,right,answer,correct,response_s,"
      "switches,at\n"
      "P1,2,1,1,liver,rec,model,,0 1 1,B,A,0,2.5,3,2026-01-01T00:00:00Z\n"
      "P1,2,2,0,liver,rec,model,,0 1 0,A,A,1,1.5,4,2026-01-01T00:00:10Z\n",
      "a.csv");
  ASSERT_EQ(study.judgements.size(), 2U);
  EXPECT_TRUE(study.slots_known);
  EXPECT_TRUE(study.judgements[0].practice);
  EXPECT_EQ(study.judgements[0].session, 2U);
  EXPECT_EQ(study.judgements[1].switches, 4U);
  EXPECT_DOUBLE_EQ(study.judgements[1].response_s, 1.5);
  EXPECT_EQ(analyse(study).all->count.trials, 1);
}

TEST(AnswersThatAreWritten, AreReadAgain) {
  Study study = test::study_with(Design::abx, {.decision = psychophysics::Decision::abx_differencing});
  study.name = R"(the "cold" one, again)";
  test::add_answers(study, "P1", R"(liver, "raw")", 7, 3);
  study.judgements[0].practice = true;
  study.judgements[1].response_s = 1.25;
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_EQ(again.name, study.name);
  EXPECT_EQ(again.task->decision, psychophysics::Decision::abx_differencing);
  ASSERT_EQ(again.judgements.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(again.judgements[i].tissue, R"(liver, "raw")");
    EXPECT_EQ(again.judgements[i].right, study.judgements[i].right);
    EXPECT_EQ(again.judgements[i].answer, study.judgements[i].answer);
    EXPECT_EQ(again.judgements[i].practice, study.judgements[i].practice);
  }
  EXPECT_DOUBLE_EQ(again.judgements[1].response_s, 1.25);
}

TEST(AnswersThatAreWritten, AreReadAgainWithoutSlots) {
  const Study study = read_answers(KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv");
  const Study again = parse_answers(answers_csv(study), "answers.csv");
  EXPECT_FALSE(again.slots_known);
  EXPECT_EQ(analyse(again).preferred, analyse(study).preferred);
  EXPECT_EQ(again.judgements.size(), 12U);
}

TEST(ATable, ThatCannotBeReadIsRefusedWithItsLine) {
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("no line of column names"));
  EXPECT_THAT(refusal("tissue,preferred\n1,a\n"), HasSubstr("a.csv:1: no column 'subject'"));
  EXPECT_THAT(refusal("subject,preferred\n1,a\n1\n"), HasSubstr("a.csv:3: 1 fields, expected 2"));
  EXPECT_THAT(refusal("subject,preferred\n1,a\n1,b\n1,c\n"), HasSubstr("a.csv:4: 'c' is a third sample"));
  EXPECT_THAT(refusal("subject,preferred\n1,a\n1,\n"), HasSubstr("a.csv:3: column 'preferred' is empty"));
  EXPECT_THAT(refusal("# design = \"same\"\nsubject,correct\n1,1\n"), HasSubstr("a.csv:1: design 'same'"));
  EXPECT_THAT(refusal("subject,correct\n1,maybe\n", Design::abx),
              HasSubstr("a.csv:2: column 'correct' is 'maybe'"));
  EXPECT_THAT(refusal("subject,level,correct\n1,big,1\n"), HasSubstr("a.csv:2: column 'level' is 'big'"));
  EXPECT_THAT(refusal("subject,level,correct\n1,,1\n"), HasSubstr("a.csv:2: column 'level' is empty"));
  EXPECT_THAT(refusal("subject,right,answer\n1,A,X\n", Design::abx), HasSubstr("expected A or B"));
  EXPECT_THAT(refusal("subject,first,second,preferred\n1,a,b,c\n"), HasSubstr("neither 'a' nor 'b'"));
  EXPECT_THAT(refusal("subject,subject,preferred\n1,1,a\n"), HasSubstr("there twice"));
  EXPECT_THAT(refusal("# task = \"oddity\"\nsubject,correct\n1,1\n", Design::abx),
              HasSubstr("a.csv:1: task 'oddity'"));
}

}  // namespace
}  // namespace kerf::bench

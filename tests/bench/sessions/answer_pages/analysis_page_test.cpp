#include "answer_pages/analysis_page.h"

#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_charts.h"
#include "answers/answers_table.h"
#include "bench/sessions/answers/studies.h"
#include "files/whole_file.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> names_of(const std::vector<Figure>& figures) {
  std::vector<std::string> names;
  for (const Figure& figure : figures) names.push_back(figure.name);
  return names;
}

TEST(TheFigures, AreThoseThatTheStudyHasSomethingFor) {
  const Study table = read_answers(KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv");
  EXPECT_THAT(names_of(analysis_figures(table, analyse(table))), testing::ElementsAre("proportions"));
  Study levels = test::study_with(Design::constant);
  levels.scale.levels = {0.05, 0.1, 0.2};
  psychophysics::Random random(1);
  test::add_observer(levels, "P1", {.threshold = 0.1}, 20, random);
  levels.judgements.front().response_s = 1.0;
  EXPECT_THAT(names_of(analysis_figures(levels, analyse(levels, {.bootstrap = 0}))),
              testing::ElementsAre("psychometric", "response-times"));
  EXPECT_TRUE(analysis_figures(Study{}, analyse(Study{})).empty());
}

// 12 answers, the mean of the subjects, four tissues, three subjects.
TEST(TheProportions, HaveALineForEachGroup) {
  const Study table = read_answers(KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv");
  const Chart chart = proportion_chart(analyse(table));
  ASSERT_EQ(chart.y_ticks.size(), 9U);
  EXPECT_EQ(chart.y_ticks[0].name, "all (12)");
  EXPECT_EQ(chart.y_ticks[5].name, "empty (3)");
  ASSERT_EQ(chart.vertical.size(), 1U);
  EXPECT_DOUBLE_EQ(chart.vertical[0].at, 50.0);
}

TEST(ThePage, SaysWhatIsShownAndWhatIsNotAndEscapesNames) {
  Study study = test::study_with(Design::abx, test::abx_task());
  study.name = "<liver> & skin";
  test::add_answers(study, "P1", "", 12, 4);
  const std::string page = analysis_page(analyse(study), {});
  EXPECT_THAT(page, HasSubstr("&lt;liver&gt; &amp; skin"));
  EXPECT_THAT(page, HasSubstr("What the answers show"));
  EXPECT_THAT(page, HasSubstr("12 of 16 right"));
  EXPECT_THAT(page, HasSubstr("What they do not show"));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST(AnAnalysisThatIsWritten, IsNotReplacedUnasked) {
  const auto folder = std::filesystem::temp_directory_path() / "kerf-session-analysis-test";
  std::filesystem::remove_all(folder);
  const Study table = read_answers(KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv");
  const Analysis analysis = analyse(table);
  EXPECT_THAT(write_analysis(table, analysis, folder, false),
              testing::ElementsAre("analysis.html", "analysis.json", "answers.csv", "proportions.svg"));
  EXPECT_THAT(read_whole_file(folder / "analysis.html"), HasSubstr("<svg"));
  EXPECT_EQ(read_answers(folder / "answers.csv").judgements.size(), 12U);
  EXPECT_THROW((void)write_analysis(table, analysis, folder, false), std::invalid_argument);
  EXPECT_FALSE(write_analysis(table, analysis, folder, true).empty());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace kerf::bench

#include "answer_pages/analysis_page.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_charts.h"
#include "answer_pages/analysis_json.h"
#include "answer_pages/analysis_words.h"
#include "answer_pages/roc_chart.h"
#include "answers/answers_table.h"
#include "bench/sessions/answers/studies.h"
#include "files/whole_file.h"
#include "support/program.h"

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

/// Ratings of one subject, from the surest "no" to the surest "yes".
void add_ratings(Study& study, const std::string& subject, const std::vector<int>& noise,
                 const std::vector<int>& signal) {
  const std::size_t levels = study.confidence_levels;
  for (std::size_t category = 0; category < noise.size(); ++category) {
    const bool yes = category >= levels;
    for (int i = 0; i < noise[category] + signal[category]; ++i) {
      study.judgements.push_back({.subject = subject,
                                  .pair = {0, 1},
                                  .right = i < noise[category] ? 0U : 1U,
                                  .answer = yes ? 1U : 0U,
                                  .confidence = yes ? category - levels + 1 : levels - category});
    }
  }
}

Study rated_study() {
  Study study = test::study_with(Design::yes_no, {.decision = psychophysics::Decision::yes_no});
  study.confidence_levels = 3;
  add_ratings(study, "P1", {174, 172, 104, 92, 41, 8}, {46, 57, 66, 101, 154, 173});
  return study;
}

const Curve& curve_with(const Chart& chart, std::string_view label) {
  for (const Curve& curve : chart.curves) {
    if (curve.label.starts_with(label)) return curve;
  }
  throw std::runtime_error("the chart has no such curve");
}

// Hits and false alarms of 597 and 591 trials, summed by hand.
TEST(TheRocCurve, HasThePointsOfTheAnalysis) {
  const Study study = rated_study();
  const Analysis analysis = analyse(study, {.bootstrap = 0});
  ASSERT_TRUE(analysis.ratings && analysis.ratings->all.area);
  const Chart chart = roc_chart(*analysis.ratings, 0.95);
  const Curve& points = curve_with(chart, "all: area");
  const std::vector<double> false_alarms{8.0 / 591, 49.0 / 591, 141.0 / 591, 245.0 / 591, 417.0 / 591};
  const std::vector<double> hits{173.0 / 597, 327.0 / 597, 428.0 / 597, 494.0 / 597, 551.0 / 597};
  EXPECT_EQ(points.x, false_alarms);
  EXPECT_EQ(points.y, hits);
  EXPECT_EQ(points.label, "all: area 0.803 (95 % 0.777 to 0.827)");
  const auto all = analysis_as_json(analysis).at("ratings").at("all");
  ASSERT_EQ(all.at("points").size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(all.at("points")[i][0].get<double>(), points.x[i]);
    EXPECT_EQ(all.at("points")[i][1].get<double>(), points.y[i]);
  }
  EXPECT_TRUE(std::ranges::none_of(chart.curves, [](const Curve& curve) {
    return curve.label.starts_with("each of");
  })) << "one subject is all";
  const auto figures = analysis_figures(study, analysis);
  EXPECT_EQ(names_of(figures).front(), "roc");
  const std::string drawing = draw(chart);
  EXPECT_THAT(drawing, HasSubstr("hit rate [1]"));
  EXPECT_THAT(drawing, HasSubstr("0.777 to 0.827")) << "the legend has room";
}

TEST(TheRocCurve, OfNormalDistributionsHasTheirAreaFromCornerToCorner) {
  const Analysis analysis = analyse(rated_study(), {.bootstrap = 0});
  const auto normal = analysis_as_json(analysis).at("ratings").at("all").at("normal");
  const Chart chart = roc_chart(*analysis.ratings, 0.95);
  const Curve& curve = curve_with(chart, "normal distributions: d_a 1.24, deviation 1.42");
  EXPECT_NEAR(curve.x.front() + curve.y.front(), 0.0, 1e-4);
  EXPECT_NEAR(curve.x.back() + curve.y.back(), 2.0, 1e-4);
  double area = 0.0;
  for (std::size_t i = 1; i < curve.x.size(); ++i)
    area += 0.5 * (curve.y[i] + curve.y[i - 1]) * (curve.x[i] - curve.x[i - 1]);
  EXPECT_NEAR(area, normal.at("area").get<double>(), 2e-4);
  EXPECT_NEAR(area, 0.80947, 2e-4) << "P(1.2387338 / sqrt2)";
}

TEST(TheRocCurve, ShowsEachSubjectBehindAll) {
  Study study = rated_study();
  add_ratings(study, "P2", {12, 9, 6, 4, 0, 1}, {2, 3, 5, 6, 9, 7});
  add_ratings(study, "P3", {3, 2, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0});  // no trial with the signal: no curve
  const Analysis analysis = analyse(study, {.bootstrap = 0});
  const Chart chart = roc_chart(*analysis.ratings, 0.95);
  EXPECT_EQ(curve_with(chart, "each of 2 subjects").x.size(), 5U);
  const auto second = analysis_as_json(analysis).at("ratings").at("by_subject")[1];
  EXPECT_DOUBLE_EQ(second.at("points")[0][1].get<double>(), 7.0 / 32.0);
  const auto has_second = [&](const Curve& curve) {
    return curve.mark == Mark::points && curve.colour == Colour::grey && curve.y.front() == 7.0 / 32.0;
  };
  EXPECT_EQ(std::ranges::count_if(chart.curves, has_second), 1);
}

TEST(TheRocCurve, IsNotDrawnWhereConfidenceWasNotAskedOrOneKindIsMissing) {
  Study study = rated_study();
  for (Judgement& each : study.judgements) each.confidence = 0;
  study.confidence_levels = 0;
  EXPECT_THAT(names_of(analysis_figures(study, analyse(study, {.bootstrap = 0}))),
              Not(testing::Contains("roc")));
  Study noise = rated_study();
  std::erase_if(noise.judgements, [](const Judgement& each) { return each.right == 1; });
  const Analysis analysis = analyse(noise, {.bootstrap = 0});
  EXPECT_THAT(names_of(analysis_figures(noise, analysis)), Not(testing::Contains("roc")));
  EXPECT_TRUE(analysis_as_json(analysis).at("ratings").at("all").at("points").empty());
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

TEST(ASentence, KeepsTheNameOfAFileAsItIs) {
  EXPECT_EQ(as_sentence("one of twelve was left out"), "One of twelve was left out.");
  EXPECT_EQ(as_sentence("study/S01.h5: opened before its end"), "study/S01.h5: opened before its end.");
  EXPECT_EQ(as_sentence("s01.h5: a rehearsal"), "s01.h5: a rehearsal.");
}

TEST(AnAnalysisThatIsWritten, IsNotReplacedUnasked) {
  const test::TemporaryFolder temporary;
  const auto folder = temporary / "analysis";
  const Study table = read_answers(KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv");
  const Analysis analysis = analyse(table);
  EXPECT_THAT(write_analysis(table, analysis, folder, false),
              testing::ElementsAre("analysis.html", "analysis.json", "answers.csv", "proportions.svg"));
  EXPECT_THAT(read_whole_file(folder / "analysis.html"), HasSubstr("<svg"));
  EXPECT_EQ(read_answers(folder / "answers.csv").judgements.size(), 12U);
  EXPECT_THROW((void)write_analysis(table, analysis, folder, false), std::invalid_argument);
  EXPECT_FALSE(write_analysis(table, analysis, folder, true).empty());
}

}  // namespace
}  // namespace kerf::bench

#include "chart/chart_picture.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;

/// kelvin at four fidelities and exponential at two, as an earlier version wrote them.
ordered_json older_chart() {
  return ordered_json::parse(
      test::read_text(std::string(KERF_SOURCE_DIR) + "/tests/bench/analysis/chart/older_chart.json"));
}

const Curve& curve(const Chart& picture, const std::string& label) {
  for (const Curve& one : picture.curves) {
    if (one.label == label) return one;
  }
  throw std::invalid_argument("no curve " + label);
}

TEST(ChartPicture, IsMadeOfWhatAnEarlierVersionWrote) {
  const ordered_json chart = older_chart();
  const Chart picture = chart_picture(chart);
  EXPECT_EQ(picture.title, "Cost of a tick over error: cut");
  EXPECT_EQ(picture.x_label, "error, root mean square [N]");
  std::vector<std::string> labels;
  for (const Curve& one : picture.curves) labels.push_back(one.label);
  EXPECT_THAT(labels, ElementsAre("front, median", "kelvin", "exponential"));
  EXPECT_THAT(curve(picture, "kelvin").of, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(curve(picture, "exponential").of, ElementsAre(4, 5));
  EXPECT_EQ(curve(picture, "exponential").x[1], chart["points"][5]["error_n"]);
  EXPECT_EQ(curve(picture, "exponential").y[1], 1e-3 * chart["points"][5]["p50_ns"].get<double>());
  EXPECT_NE(curve(picture, "exponential").colour, curve(picture, "kelvin").colour);
  EXPECT_EQ(picture.vertical.at(0).at, chart["jnd_n"]);
  EXPECT_TRUE(picture.horizontal.empty()) << "5 ms a tick would press points of 10 ns into a corner";
  EXPECT_EQ(picture.y_label, "cost of a tick [µs]; a tick at 200 Hz has 5000");
}

TEST(ChartPicture, ShowsTheDeadlineWhereALawComesNearIt) {
  ordered_json chart = older_chart();
  chart["cold_tail"] = "p99.9";
  chart["points"][0].update({{"cold_p999_ns", 300e3}, {"on_cold_front", false}});
  EXPECT_TRUE(chart_picture(chart).horizontal.empty()) << "only the front's cold costs are drawn";
  chart["points"][0]["on_cold_front"] = true;
  const Chart picture = chart_picture(chart);
  ASSERT_EQ(picture.horizontal.size(), 2U);
  EXPECT_NEAR(picture.horizontal[0].at, 5000.0, 1e-6);
  EXPECT_GT(picture.y_range.end, 5000.0);
}

TEST(ChartPicture, SpreadsItsPointsOverIt) {  // finding S23
  const Chart picture = chart_picture(older_chart());
  EXPECT_LT(picture.y_range.end / picture.y_range.begin, 1e3);
}

TEST(ChartPicture, LeadsTheFrontFromTheRightBorderDownItsPointsToTheUpper) {
  ordered_json chart = older_chart();
  for (auto& point : chart["points"]) point["on_front"] = point["fidelity"] == "exact";
  chart["points"][4].update({{"on_front", true}, {"p50_ns", 5.0}});
  const Chart picture = chart_picture(chart);
  const double accurate = chart["points"][0]["error_n"];
  const double cheap = chart["points"][4]["error_n"];
  const double dear_us = 1e-3 * chart["points"][0]["p50_ns"].get<double>();
  EXPECT_THAT(curve(picture, "front, median").x,
              ElementsAre(picture.x_range.end, cheap, cheap, accurate, accurate));
  EXPECT_THAT(curve(picture, "front, median").y,
              ElementsAre(0.005, 0.005, dear_us, dear_us, picture.y_range.end));
  EXPECT_EQ(picture.labels.at(0).text, "exponential, as fitted");
  EXPECT_TRUE(picture.labels.at(0).left) << "it stands at the right";
  EXPECT_FALSE(picture.labels.at(1).left);
}

TEST(ChartPicture, LeadsTheColdFrontByTheTailThatWasMeasured) {
  ordered_json chart = older_chart();
  chart["cold_tail"] = "p99";
  chart["points"][1].update({{"cold_p99_ns", 700.0}, {"on_cold_front", true}});
  const Chart picture = chart_picture(chart);
  EXPECT_TRUE(curve(picture, "front, cold p99").dashed);
  EXPECT_THAT(curve(picture, "front, cold p99").y,
              ElementsAre(1e-3 * 700.0, 1e-3 * 700.0, picture.y_range.end));
  EXPECT_EQ(picture.labels.back().text, "kelvin, exact, float");
  EXPECT_EQ(picture.labels.back().y, 1e-3 * 700.0);
}

TEST(ChartPicture, IsHollowWhereTooManyTicksAreOutsideTheJnd) {
  ordered_json chart = older_chart();
  chart["jnd_fraction_limit"] = 0.05;
  chart["points"][0]["jnd_fraction"] = 0.06;
  chart["points"][1]["jnd_fraction"] = 0.04;
  chart["points"][4]["jnd_fraction"] = 0.3;
  chart["points"][5]["jnd_fraction"] = 0.3;
  const Chart picture = chart_picture(chart);
  EXPECT_THAT(curve(picture, "kelvin").of, ElementsAre(1, 2, 3));
  EXPECT_EQ(curve(picture, "exponential").mark, Mark::circles) << "all of it";
  EXPECT_EQ(picture.labels.at(0).text, "kelvin, exact, 6 % outside");
  EXPECT_EQ(picture.x_label, "error, root mean square [N]; hollow: over 5 % of ticks outside the JND");
}

TEST(ChartPicture, MarksApartWhatIsNotStableAndWhatNobodyJudged) {
  ordered_json chart = older_chart();
  chart["points"][0]["stable"] = nullptr;
  chart["points"][4]["stable"] = false;
  const Chart picture = chart_picture(chart);
  EXPECT_THAT(curve(picture, "stability not judged").x, ElementsAre(chart["points"][0]["error_n"]));
  EXPECT_THAT(curve(picture, "not stable").x, ElementsAre(chart["points"][4]["error_n"]));
  EXPECT_NE(curve(picture, "stability not judged").mark, curve(picture, "not stable").mark);
  EXPECT_EQ(picture.title, "Cost of a tick over error: cut");
  for (auto& point : chart["points"]) {
    if (point["stable"] == true) point["stable"] = nullptr;
  }
  EXPECT_EQ(chart_picture(chart).title, "Cost of a tick over error: cut, stability not judged");
  EXPECT_THROW((void)curve(chart_picture(chart), "stability not judged"), std::invalid_argument);
}

TEST(ChartPicture, KeepsWithinItsBordersWhatIsUnknownOrTooSmall) {
  ordered_json chart = older_chart();
  chart["compared_in"] = "JND";
  chart["points"][0].update({{"error_jnd", nullptr}, {"p50_ns", 0.1}, {"stable", false}});
  chart["points"][1]["error_jnd"] = 0.0;
  const Chart picture = chart_picture(chart);
  EXPECT_EQ(picture.x_label, "error, root mean square [JND]; at the edges: less, more");
  EXPECT_EQ(curve(picture, "kelvin").x[0], 100.0);
  EXPECT_EQ(curve(picture, "kelvin").x[1], 1e-2);
  EXPECT_EQ(curve(picture, "kelvin").y[0], 2e-3);
  EXPECT_THAT(curve(picture, "not stable").x, ElementsAre(100.0));
  EXPECT_EQ(picture.x_range.begin, 0.5e-2);
  EXPECT_EQ(picture.x_range.end, 300.0);
}

TEST(ChartPicture, HasTheErrorsOfATorqueInItsOwnUnit) {
  ordered_json chart = older_chart();
  chart["compared_in"] = "N·m";
  const Chart picture = chart_picture(chart);
  EXPECT_THAT(picture.x_label, testing::StartsWith("error, root mean square [N·m]"));
  EXPECT_EQ(picture.vertical.back().at, chart["jnd_n"].get<double>()) << "the line of the JND";
  EXPECT_EQ(curve(picture, "kelvin").x, curve(chart_picture(older_chart()), "kelvin").x);
}

TEST(ChartPicture, SaysHowFarTheReferenceItselfErrs) {
  ordered_json chart = older_chart();
  chart["reference_error"] = {{"converges", true}, {"estimate_jnd", 0.5}};
  EXPECT_EQ(chart_picture(chart).vertical.at(0).at, 0.5 * chart["jnd_n"].get<double>());
  chart["reference_error"] = {{"converges", false}, {"estimate_jnd", nullptr}};
  EXPECT_EQ(chart_picture(chart).vertical.size(), 1U);
  EXPECT_EQ(chart_picture(chart).title, "Cost of a tick over error: cut; its reference has not converged");
}

TEST(ChartPicture, RefusesWhatIsNoChart) {
  ordered_json chart = older_chart();
  chart["points"][2].erase("p50_ns");
  EXPECT_THROW((void)chart_picture(chart), nlohmann::json::exception);
}

}  // namespace
}  // namespace kerf::bench

#include "report/charts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "segment/segment.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

/// Where the numbers of the time axis stand [px], by what they say: of all texts those that are lowest.
std::map<std::string, double> numbers_of_the_time(const std::string& svg) {
  const std::regex text(
      R"(translate\(([0-9.]+),([0-9.]+)\)[^>]*>\s*<text>(?:<tspan[^>]*>)?\s*([0-9.]+)\s*<)");
  std::map<double, std::map<std::string, double>> by_height;
  for (std::sregex_iterator at(svg.begin(), svg.end(), text), end; at != end; ++at)
    by_height[std::stod((*at)[2])][(*at)[3]] = std::stod((*at)[1]);
  return by_height.empty() ? std::map<std::string, double>() : by_height.rbegin()->second;
}

TEST(ReportCharts, TheSameTimeStandsAtTheSamePlaceInPositionAndForce) {
  schema::Recording recording = test::punch();
  for (double& force : recording.force_measured) force *= 1e4;  // numbers longer than those of the position
  const schema::RowsInMemory rows(recording);
  const auto position = numbers_of_the_time(draw(position_chart(recording, rows, 0)));
  const auto force = numbers_of_the_time(draw(force_chart(recording, rows, 0)));
  EXPECT_GT(position.size(), 3U);
  EXPECT_EQ(position, force);
}

TEST(ReportCharts, TheTimeAxisEndsWithTheRecording) {
  const schema::Recording recording = test::punch();
  const Chart chart = force_chart(recording, schema::RowsInMemory(recording), 0);
  EXPECT_EQ(chart.x_range.begin, recording.time.front());
  EXPECT_EQ(chart.x_range.end, recording.time.back());
}

const Curve& curve_named(const Chart& chart, const std::string& label) {
  const auto found = std::ranges::find(chart.curves, label, &Curve::label);
  if (found == chart.curves.end()) throw std::out_of_range(label);
  return *found;
}

// As in the page: tests/bench/studio/page/convention_pages.mjs.
TEST(ReportCharts, DrawClosingInBlueAndOpeningInOrangeToRed) {
  schema::Recording recording = test::punch({.seconds = 8.0});
  recording.cycles = find_cycles(recording, {});
  const schema::RowsInMemory rows(recording);
  const Chart position = position_chart(recording, rows, 0);
  for (const schema::PhaseSpan& span : recording.cycles->phases) {
    if (span.phase != schema::Phase::closing && span.phase != schema::Phase::opening) continue;
    const auto band = std::ranges::find(position.bands, recording.time[span.begin], &Band::begin);
    ASSERT_NE(band, position.bands.end());
    EXPECT_EQ(band->colour, span.phase == schema::Phase::closing ? Colour::blue : Colour::orange);
  }
  const Chart loops = loop_chart(recording, rows, 0);
  EXPECT_EQ(curve_named(loops, "closing").colour, Colour::sky);
  EXPECT_EQ(curve_named(loops, "closing, mean").colour, Colour::blue);
  EXPECT_EQ(curve_named(loops, "opening").colour, Colour::orange);
  EXPECT_EQ(curve_named(loops, "opening, mean").colour, Colour::vermillion);
}

TEST(ReportCharts, OfManyCyclesSomeAreDrawnAsTheyRanAndNotAllAsStraightLines) {
  schema::Recording recording = test::punch({.seconds = 100.0});
  for (std::size_t row = 0; row < recording.rows();
       ++row) {  // 5 mm in and out, in step with no stretch of rows
    const double turn = 2.0 * 3.14159265358979 * 1.037 * recording.time[row];
    recording.position[row] = 0.0025 * (1.0 - std::cos(turn));
    recording.force_measured[row] = (std::sin(turn) > 0.0 ? 500.0 : 300.0) * recording.position[row];
  }
  recording.cycles = find_cycles(recording, {});
  ASSERT_GT(recording.cycles->closing.size(), 60U);
  const Chart chart = loop_chart(recording, schema::RowsInMemory(recording), 0);
  const Curve& closing = chart.curves.at(1);
  EXPECT_TRUE(std::regex_match(closing.label, std::regex("closing, [0-9]+ of [0-9]+"))) << closing.label;
  double longest_mm = 0.0;
  for (std::size_t i = 1; i < closing.x.size(); ++i) {
    if (!std::isnan(closing.x[i] - closing.x[i - 1]))
      longest_mm = std::max(longest_mm, std::abs(closing.x[i] - closing.x[i - 1]));
  }
  EXPECT_LT(longest_mm, 0.5) << "of a stroke of 5 mm";
}

}  // namespace
}  // namespace kerf::bench

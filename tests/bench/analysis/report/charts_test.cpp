#include "report/charts.h"

#include <map>
#include <regex>
#include <string>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace kerf::bench

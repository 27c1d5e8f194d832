#include "report/cycle_section.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segment/segment.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

schema::Recording in_cycles() {
  schema::Recording recording = test::punch({.seconds = 8.0});
  recording.cycles = find_cycles(recording, {});
  return recording;
}

std::string section(const schema::Recording& recording) {
  return cycle_section(schema::RowsInMemory(recording), 0);
}

void keep(schema::Recording& recording, std::vector<schema::CycleFlag> flags) {
  recording.cycle_flags = {.created = "2026-01-02T03:04:05Z", .software = "kerf test", .felt = 0.05};
  recording.cycle_flags->flags = std::move(flags);
}

TEST(CycleSection, SaysOfAFlaggedCycleWhyItDoesNotCount) {
  schema::Recording recording = in_cycles();
  keep(recording, {{.cycle = 2, .fault = "by_hand", .reason = "the <b>tissue</b> slipped"}});
  const std::string html = section(recording);
  const std::size_t cycles = recording.cycles->closing.size();
  ASSERT_GT(cycles, 3U);
  EXPECT_THAT(html,
              HasSubstr(std::to_string(cycles - 1) + " of " + std::to_string(cycles) + " cycles count"));
  EXPECT_THAT(html, HasSubstr("<td>no</td><td>by_hand</td><td>the &lt;b&gt;tissue&lt;/b&gt; slipped</td>"));
  EXPECT_THAT(html, AllOf(HasSubstr("<svg"), HasSubstr("cycles that do not count"), HasSubstr("peak [N]")));
  EXPECT_THAT(html, HasSubstr("of 2026-01-02T03:04:05Z by kerf test; in contact beyond 0.05 N"));
}

TEST(CycleSection, CallsWorkAnEnergyOnlyWhereItIsOne) {
  schema::Recording recording = in_cycles();
  EXPECT_THAT(section(recording), HasSubstr("closing work [J]"));
  recording.axes[0].position_unit = "rad";
  EXPECT_THAT(section(recording), HasSubstr("closing work [N·rad]"));
  recording.axes[0].force_unit = "N·m";
  EXPECT_THAT(section(recording), HasSubstr("closing work [J]"));
}

TEST(CycleSection, CountsAFlaggedCycleThatSomebodyAccepted) {
  schema::Recording recording = in_cycles();
  keep(recording, {{.cycle = 1, .fault = "outlier", .reason = "far off"},
                   {.cycle = 1, .fault = "accepted", .reason = "a slow one"}});
  const std::string html = section(recording);
  EXPECT_THAT(html,
              HasSubstr("<td>yes</td><td>outlier, accepted</td><td>far off; accepted: a slow one</td>"));
  EXPECT_THAT(html, Not(HasSubstr("<svg"))) << "all count: there is nothing to show";
}

TEST(CycleSection, GoesByWhatTheRecordingKeepsAndNotByWhatWouldBeFoundNow) {
  schema::Recording recording = in_cycles();
  for (std::size_t row = 0; row < recording.rows(); ++row) {  // nothing is felt any more
    recording.force_measured[row] *= 1e-3;
  }
  EXPECT_THAT(section(recording), AllOf(HasSubstr("under_force"), HasSubstr("keeps no flags")));
  keep(recording, {});
  EXPECT_THAT(section(recording), AllOf(Not(HasSubstr("under_force")), Not(HasSubstr("keeps no flags"))));
}

TEST(CycleSection, FoldsAwayCyclesWithoutRemarkOfALongRecording) {
  schema::Recording recording = test::punch({.seconds = 20.0});
  recording.cycles = find_cycles(recording, {});
  ASSERT_GT(recording.cycles->closing.size(), 40U);
  keep(recording, {{.cycle = 7, .fault = "by_hand", .reason = "it slipped"}});
  const std::string html = section(recording);
  const std::string open = html.substr(0, html.find("<details>"));
  EXPECT_THAT(open, AllOf(HasSubstr("<td>7</td>"), Not(HasSubstr("<td>8</td>"))));
  EXPECT_THAT(html, HasSubstr("<td>8</td>"));
}

TEST(CycleSection, IsEmptyWithoutCyclesAndSaysWhichOnesAreOfNoRows) {
  EXPECT_EQ(section(test::punch()), "");
  schema::Recording recording = in_cycles();
  recording.cycles->phases.back().end = recording.rows() + 1;
  EXPECT_THAT(section(recording), AllOf(HasSubstr("<h2>Cycles</h2>"), Not(HasSubstr("<table"))));
}

}  // namespace
}  // namespace kerf::bench

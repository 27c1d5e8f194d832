#include "recordings/row_figures.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/schema/recording_file.h>
#include <kerf/schema/recording_writer.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

/// Rows of a loop at 1 kHz with everything that a summary counts: ticks that are missing, steps that are long
/// though none is, times that repeat or go back, values that are not finite.
std::vector<schema::Row> odd_rows() {
  std::vector<schema::Row> rows;
  std::uint64_t tick = 0;
  for (std::uint64_t i = 0; i < 70'000; ++i) {
    tick += i % 997 == 0 ? 3 : 1;
    schema::Row row{.tick = tick, .time_s = 1e-3 * static_cast<double>(tick)};
    if (i % 5003 == 0) row.time_s += 2e-3;
    row.position = {std::sin(row.time_s), 1e-6 * static_cast<double>(i)};
    row.force_measured = {-row.time_s, std::cos(row.time_s)};
    row.channels = {293.0 + row.time_s};
    row.wake_latency_s = 1e-6F * static_cast<float>(i % 13);
    rows.push_back(row);
  }
  rows[100].time_s = rows[99].time_s;
  rows[200].time_s = rows[100].time_s;
  rows[300].time_s = std::numeric_limits<double>::quiet_NaN();
  rows[400].position[1] = std::numeric_limits<double>::infinity();
  return rows;
}

/// What is found in the file of those rows, and what was gathered on their way into it.
struct Both {
  RowFigures of_file;
  RowFigures on_the_way;
};

Both figures_of_rows(const std::vector<schema::Row>& rows, bool measures_force) {
  const test::TemporaryFolder folder;
  schema::RecordingWriter writer(
      folder / "r.h5", schema::new_header("kerf test"), {{.name = "x"}, {.name = "y"}},
      {.measures_force = measures_force, .channels = {{.name = "temperature", .unit = "K", .values = {}}}});
  RowTally tally(2, 1, measures_force);
  constexpr std::size_t at_once = 999;
  for (std::size_t first = 0; first < rows.size(); first += at_once) {
    const auto some = std::span(rows).subspan(first, std::min(at_once, rows.size() - first));
    writer.append(some);
    tally.add(some);
  }
  writer.close("complete");
  return {.of_file = figures_of(schema::RecordingFile(folder / "r.h5")), .on_the_way = tally.figures()};
}

TEST(RowTally, GathersWhatAPassOverTheFileFinds) {
  for (const bool measures_force : {false, true}) {
    const auto [of_file, on_the_way] = figures_of_rows(odd_rows(), measures_force);
    EXPECT_TRUE(of_file == on_the_way);
    EXPECT_EQ(of_file.rows, 70'000U);
    EXPECT_GT(of_file.gaps, 70U) << "of missing ticks and of long steps";
    EXPECT_EQ(of_file.repeated, 1U);
    EXPECT_GT(of_file.backward, 0U);
    EXPECT_EQ(of_file.times_not_finite, 1U);
    EXPECT_EQ(of_file.columns.contains(schema::Column::force_measured), measures_force);
  }
}

TEST(RowTally, HoldsForNoRowAndForOne) {
  for (const std::size_t count : {0U, 1U}) {
    const auto [of_file, on_the_way] = figures_of_rows(std::vector<schema::Row>(count), true);
    EXPECT_TRUE(of_file == on_the_way) << count;
    EXPECT_EQ(on_the_way.rows, count);
    EXPECT_EQ(on_the_way.period_s, 0.0);
  }
}

}  // namespace
}  // namespace kerf::bench

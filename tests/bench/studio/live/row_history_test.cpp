#include "live/row_history.h"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::IsNan;
using testing::SizeIs;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double period_s = 1e-3;

drivers::DeviceInfo scissors(bool measures_force = true) {
  return {.axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N·m"},
                   {.name = "x_s", .position_unit = "m", .force_unit = "N"}},
          .channels = {{.name = "grip", .unit = "N"}},
          .measures_force = measures_force};
}

schema::Row row_of(std::uint64_t tick, double position = 0.0) {
  return {.tick = tick, .time_s = period_s * static_cast<double>(tick), .position = {position}};
}

void append_ticks(RowHistory& history, std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t tick = begin; tick < end; ++tick)
    history.append(std::vector{row_of(tick, static_cast<double>(tick))});
}

TEST(RowHistory, NamesTheTracesOfADeviceWithTheirUnits) {
  const std::vector<Trace> traces = traces_of(scissors());
  std::vector<std::string> lines;
  for (const Trace& it : traces) lines.push_back(fmt::format("{} [{}] {}", it.name, it.unit, it.group));
  EXPECT_THAT(lines, ElementsAre("position theta [rad] position", "position x_s [m] position",
                                 "velocity theta [rad/s] velocity", "velocity x_s [m/s] velocity",
                                 "force_commanded theta [N·m] force", "force_commanded x_s [N] force",
                                 "force_measured theta [N·m] force", "force_measured x_s [N] force",
                                 "wake_latency [s] timing", "read_time [s] timing", "compute_time [s] timing",
                                 "write_time [s] timing", "cycle_time [s] timing", "grip [N] channel"));
  EXPECT_THAT(traces_of(scissors(false)), SizeIs(12)) << "what it does not measure is no trace";
}

TEST(RowHistory, KeepsEveryValueOfARowUnderItsTrace) {
  RowHistory history(scissors(), period_s);
  history.append(std::vector{schema::Row{.position = {1, 2},
                                         .velocity = {3, 4},
                                         .force_commanded = {5, 6},
                                         .force_measured = {7, 8},
                                         .channels = {9},
                                         .wake_latency_s = 10,
                                         .read_time_s = 20,
                                         .compute_time_s = 30,
                                         .write_time_s = 40}});
  const LiveFrame frame = history.frame_since(0, 1, 10);
  EXPECT_EQ(frame.columns, 1U);
  EXPECT_THAT(frame.smallest, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 10, 20, 30, 40, 90, 9));
  EXPECT_EQ(frame.smallest, frame.largest);
}

TEST(RowHistory, GivesAColumnOnlyWhenNoRowOfItCanComeAnyMore) {
  RowHistory history(scissors(), period_s);
  EXPECT_EQ(history.frame_since(0, 10, 600).columns, 0U);
  append_ticks(history, 0, 19);
  LiveFrame frame = history.frame_since(0, 10, 600);
  EXPECT_EQ(frame.columns, 1U);
  EXPECT_EQ(frame.next, 10U);
  EXPECT_EQ(frame.largest[0], 9.0);
  EXPECT_EQ(history.frame_since(10, 10, 600).columns, 0U);
  append_ticks(history, 19, 20);
  frame = history.frame_since(10, 10, 600);
  EXPECT_EQ(frame.from, 10U);
  EXPECT_EQ(frame.columns, 1U) << "its last tick is there";
  EXPECT_EQ(frame.smallest[0], 10.0);
  EXPECT_EQ(frame.largest[0], 19.0);
  append_ticks(history, 20, 23);
  EXPECT_EQ(history.frame_since(20, 10, 600).columns, 0U);
  history.finish();
  frame = history.frame_since(20, 10, 600);
  EXPECT_EQ(frame.columns, 1U) << "the loop has ended: no row comes any more";
  EXPECT_EQ(frame.largest[0], 22.0);
}

TEST(RowHistory, LeavesAColumnWithoutRowsEmpty) {
  RowHistory history(scissors(), period_s);
  append_ticks(history, 0, 2);
  history.append(std::vector{row_of(7, not_a_number), row_of(9, std::numeric_limits<double>::infinity()),
                             row_of(10, 3.0)});
  const LiveFrame frame = history.frame_since(0, 2, 600);
  ASSERT_EQ(frame.columns, 5U);
  EXPECT_THAT(std::vector(frame.smallest.begin(), frame.smallest.begin() + 5),
              ElementsAre(0.0, IsNan(), IsNan(), IsNan(), IsNan()));
  EXPECT_EQ(frame.smallest[5 + 3], 0.0) << "x_s, which tick 7 did measure";
}

TEST(RowHistory, SendsAtMostSoManyColumnsAndGoesOnFromThere) {
  RowHistory history(scissors(), period_s);
  append_ticks(history, 0, 100);
  const LiveFrame first = history.frame_since(0, 1, 60);
  EXPECT_EQ(first.columns, 60U);
  const LiveFrame second = history.frame_since(first.next, 1, 60);
  EXPECT_EQ(second.from, 60U);
  EXPECT_EQ(second.columns, 40U);
}

TEST(RowHistory, SkipsAheadWhereAViewerLagsMoreThanItKeeps) {
  RowHistory history(scissors(), 0.1);  // 600 rows
  EXPECT_EQ(history.capacity(), 600U);
  append_ticks(history, 0, 1005);  // 405 to 1004 are left
  const LiveFrame frame = history.frame_since(20, 10, 600);
  EXPECT_EQ(frame.from, 410U) << "the column of 405 is not whole any more";
  EXPECT_EQ(frame.smallest[0], 410.0);
  EXPECT_EQ(frame.next, 1000U);
}

TEST(RowHistory, IsAMinuteButAtMost120000Rows) {
  EXPECT_EQ(RowHistory(scissors(), 1e-3).capacity(), 60'000U);
  EXPECT_EQ(RowHistory(scissors(), 1e-4).capacity(), 120'000U);
}

TEST(RowHistory, TellsEveryEventOnceWhateverTheFramesAreCutInto) {
  RowHistory history(scissors(), period_s);
  for (std::uint64_t tick = 0; tick < 2000; ++tick) {
    schema::Row row = row_of(tick);
    if (tick % 400 == 7) row.flags = schema::flag_force_limited;
    const LiveEvent law{.tick = tick, .event = {.time_s = row.time_s, .kind = "law", .text = "kelvin"}};
    history.append(std::vector{row}, tick == 1000 ? std::vector{law} : std::vector<LiveEvent>{});
  }
  std::vector<std::string> seen;
  std::uint64_t next = 0;
  for (const std::uint64_t ticks : {3U, 10U, 7U, 100U, 1U, 1U, 13U}) {
    const LiveFrame frame = history.frame_since(next, ticks, ticks == 13 ? 1000 : 20);
    for (const schema::Event& it : frame.events) seen.push_back(fmt::format("{} {:.3f}", it.kind, it.time_s));
    next = frame.next;
  }
  EXPECT_THAT(seen, ElementsAre("force_limited 0.007", "force_limited 0.407", "force_limited 0.807",
                                "law 1.000", "force_limited 1.207", "force_limited 1.607"));
}

/// Rows with gaps, numbers that are none and spikes of one row.
std::vector<schema::Row> spiky_rows(std::mt19937& random, std::size_t count) {
  std::vector<schema::Row> rows;
  std::uniform_int_distribution<int> dice(0, 99);
  std::uint64_t tick = 0;
  for (std::size_t i = 0; i < count; ++i) {
    tick += dice(random) < 5 ? static_cast<std::uint64_t>(1 + dice(random)) : 1;
    double value = 0.01 * dice(random);
    if (dice(random) < 3) value = (dice(random) < 50 ? -1.0 : 1.0) * std::pow(10.0, dice(random) % 9);
    if (dice(random) < 2) value = not_a_number;
    rows.push_back(row_of(tick, value));
  }
  return rows;
}

struct Extremes {
  double smallest = not_a_number;
  double largest = not_a_number;
};

template <typename Inside>
Extremes range_of(const std::vector<schema::Row>& rows, Inside inside) {
  Extremes range;
  for (const schema::Row& row : rows) {
    if (!inside(row) || !std::isfinite(row.position[0])) continue;
    range.smallest = std::fmin(range.smallest, row.position[0]);
    range.largest = std::fmax(range.largest, row.position[0]);
  }
  return range;
}

bool same(double left, double right) { return left == right || (std::isnan(left) && std::isnan(right)); }

TEST(RowHistory, LosesNoSpikeWhateverTheRowsAndTheFramesAreCutInto) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const std::vector<schema::Row> rows = spiky_rows(random, 1500);
    std::uniform_int_distribution<std::size_t> chunk(1, 200);
    const std::uint64_t ticks = std::uniform_int_distribution<std::uint64_t>(1, 40)(random);
    RowHistory history(scissors(), period_s);
    std::uint64_t next = 0;
    std::size_t columns = 0;
    for (std::size_t row = 0; row < rows.size();) {
      const std::size_t count = std::min(chunk(random), rows.size() - row);
      history.append({rows.data() + row, count});
      row += count;
      if (row == rows.size()) history.finish();
      do {
        const LiveFrame frame = history.frame_since(next, ticks, 1 + chunk(random));
        ASSERT_TRUE(frame.columns == 0 || frame.from == next) << "no column is left out";
        for (std::size_t column = 0; column < frame.columns; ++column, ++columns) {
          const std::uint64_t from = frame.from + column * ticks;
          const Extremes expected = range_of(
              rows, [&](const schema::Row& it) { return it.tick >= from && it.tick < from + ticks; });
          ASSERT_TRUE(same(frame.smallest[column], expected.smallest)) << "tick " << from;
          ASSERT_TRUE(same(frame.largest[column], expected.largest)) << "tick " << from;
        }
        next = frame.next;
      } while (row == rows.size() && next <= rows.back().tick);
    }
    EXPECT_EQ(columns, rows.back().tick / ticks + 1);
  }
}

TEST(RowHistory, LosesNoSpikeInAView) {
  const std::vector<std::size_t> trace{0};
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const std::vector<schema::Row> rows = spiky_rows(random, 3000);
    RowHistory history(scissors(), 1.0 / 40.0);  // 2400 rows: the first ones are forgotten
    history.append(rows);
    const std::vector<schema::Row> kept(rows.end() - 2400, rows.end());
    std::uniform_real_distribution<double> moment(0.0, rows.back().time_s);
    const double from_s = seed == 0 ? 0.0 : moment(random);
    const double to_s = seed == 0 ? 1e9 : from_s + moment(random);
    const std::size_t columns = std::uniform_int_distribution<std::size_t>(1, 900)(random);
    const TraceView view = history.view(trace, from_s, to_s, columns);
    ASSERT_LE(view.time_s.size(), columns);
    Extremes seen;
    for (std::size_t column = 0; column < view.time_s.size(); ++column) {
      const double end_s = column + 1 < view.time_s.size() ? view.time_s[column + 1] : to_s + 1e-9;
      const Extremes expected = range_of(
          kept, [&](const schema::Row& it) { return it.time_s >= view.time_s[column] && it.time_s < end_s; });
      const double smallest = view.traces[0].smallest[column];
      const double largest = view.traces[0].largest[column];
      ASSERT_EQ(std::isnan(smallest), std::isnan(expected.smallest));
      ASSERT_FALSE(smallest < expected.smallest - 1.2e-7 * std::abs(expected.smallest));
      ASSERT_FALSE(largest > expected.largest + 1.2e-7 * std::abs(expected.largest));
      ASSERT_FALSE(smallest > expected.smallest) << "rounded away from the other end";
      ASSERT_FALSE(largest < expected.largest);
      seen.smallest = std::fmin(seen.smallest, smallest);
      seen.largest = std::fmax(seen.largest, largest);
    }
    const Extremes whole =
        range_of(kept, [&](const schema::Row& it) { return it.time_s >= from_s && it.time_s <= to_s; });
    ASSERT_FALSE(seen.smallest > whole.smallest) << "seed " << seed;
    ASSERT_FALSE(seen.largest < whole.largest);
  }
}

TEST(RowHistory, ShowsEveryRowWhereThereIsRoomForAll) {
  RowHistory history(scissors(), period_s);
  append_ticks(history, 0, 100);
  const std::vector<std::size_t> traces{0, 1};
  const TraceView view = history.view(traces, 0.0105, 0.0145, 50);
  EXPECT_EQ(view.rows_per_column, 1.0);
  EXPECT_THAT(view.traces[0].smallest, ElementsAre(11.0F, 12.0F, 13.0F, 14.0F));
  EXPECT_THAT(view.traces[1].largest, ElementsAre(0.0F, 0.0F, 0.0F, 0.0F));
  EXPECT_THAT(history.view(traces, 5.0, 4.0, 50).time_s, SizeIs(0));
}

TEST(RowHistory, RefusesATraceThatThereIsNot) {
  const RowHistory history(scissors(), period_s);
  const std::vector<std::size_t> traces{14};
  EXPECT_THROW((void)history.view(traces, 0.0, 1.0, 10), std::invalid_argument);
  const std::vector<std::size_t> none;
  EXPECT_THROW((void)history.view(none, 0.0, 1.0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

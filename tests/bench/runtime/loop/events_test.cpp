#include "loop/events.h"

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

std::vector<schema::Event> events_of(const std::vector<schema::Row>& rows) {
  EventFinder finder;
  std::vector<schema::Event> events;
  for (const schema::Row& row : rows) finder.process(row, events);
  return events;
}

schema::Row row_at(std::uint64_t tick, std::uint32_t flags) {
  return {.tick = tick, .time_s = 1e-3 * static_cast<double>(tick), .flags = flags};
}

TEST(Events, AreNoneForRowsWithoutFlags) { EXPECT_TRUE(events_of({row_at(0, 0), row_at(1, 0)}).empty()); }

TEST(Events, NameEachFlagOfARow) {
  const auto events = events_of({row_at(3, schema::flag_force_limited | schema::flag_device_fault)});
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, "force_limited");
  EXPECT_EQ(events[1].kind, "device_fault");
  EXPECT_EQ(events[1].time_s, 0.003);
}

TEST(Events, SayOnceWhatHoversAndAgainWhatCameBack) {
  std::vector<schema::Row> rows;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    const bool hovers = tick < 400 && tick % 3 == 0;
    const bool back = tick == 700;
    rows.push_back(row_at(tick, hovers || back ? schema::flag_slew_limited : 0U));
  }
  const auto events = events_of(rows);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].time_s, 0.0);
  EXPECT_DOUBLE_EQ(events[1].time_s, 0.7);
}

TEST(Events, CountTheTicksThatAGapLeavesOut) {
  const auto events = events_of({row_at(4, 0), row_at(8, schema::flag_missed_deadline)});
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].text, "3 ticks are not in the file: deadlines were missed before this tick");
}

}  // namespace
}  // namespace kerf::bench

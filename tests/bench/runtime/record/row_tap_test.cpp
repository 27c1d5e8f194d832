#include "record/row_tap.h"

#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

std::vector<schema::Row> popped(RowTap& tap) {
  std::vector<schema::Row> rows(RowRing::max_popped);
  rows.resize(tap.pop(rows.data()));
  return rows;
}

TEST(RowTap, LosesWhatFindsNoRoomAndFlagsTheNextThatDoes) {
  RowTap tap(3);
  for (std::uint64_t tick = 0; tick < 5; ++tick) tap.push({.tick = tick, .flags = schema::flag_soft_start});
  EXPECT_FALSE(tap.has_room());
  EXPECT_EQ(tap.lost(), 2U);
  for (const schema::Row& row : popped(tap)) EXPECT_EQ(row.flags, schema::flag_soft_start) << row.tick;
  EXPECT_TRUE(tap.has_room());
  tap.push({.tick = 5, .flags = schema::flag_soft_start});
  tap.push({.tick = 6});
  const std::vector<schema::Row> rows = popped(tap);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].tick, 5U);
  EXPECT_EQ(rows[0].flags, schema::flag_soft_start | schema::flag_rows_lost);
  EXPECT_EQ(rows[1].flags, 0U);
  EXPECT_EQ(tap.lost(), 2U);
}

}  // namespace
}  // namespace kerf::bench

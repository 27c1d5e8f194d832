#include "record/row_ring.h"

#include <thread>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(RowRing, RefusesARowWhenItIsFullAndTakesOneAgainWhenItIsNot) {
  RowRing ring(3);
  for (std::uint64_t tick = 0; tick < 3; ++tick) EXPECT_TRUE(ring.push({.tick = tick}));
  EXPECT_FALSE(ring.push({.tick = 3}));
  std::vector<schema::Row> rows(RowRing::max_popped);
  ASSERT_EQ(ring.pop(rows.data()), 3U);
  for (std::uint64_t tick = 0; tick < 3; ++tick) EXPECT_EQ(rows[tick].tick, tick);
  EXPECT_EQ(ring.pop(rows.data()), 0U);
  EXPECT_TRUE(ring.push({.tick = 4}));
  ASSERT_EQ(ring.pop(rows.data()), 1U);
  EXPECT_EQ(rows[0].tick, 4U);
}

TEST(RowRing, HandsEveryRowFromThreadToThreadUnchanged) {
  constexpr std::uint64_t count = 200'000;
  RowRing ring(64);
  std::jthread tick([&] {
    for (std::uint64_t i = 0; i < count; ++i) {
      while (
          !ring.push({.tick = i, .time_s = static_cast<double>(i), .flags = static_cast<std::uint32_t>(i)})) {
        std::this_thread::yield();
      }
    }
  });
  std::vector<schema::Row> rows(RowRing::max_popped);
  for (std::uint64_t next = 0; next < count;) {
    const std::size_t popped = ring.pop(rows.data());
    for (std::size_t i = 0; i < popped; ++i, ++next) {
      ASSERT_EQ(rows[i].tick, next);
      ASSERT_EQ(rows[i].time_s, static_cast<double>(next));
      ASSERT_EQ(rows[i].flags, static_cast<std::uint32_t>(next));
    }
  }
}

}  // namespace
}  // namespace kerf::bench

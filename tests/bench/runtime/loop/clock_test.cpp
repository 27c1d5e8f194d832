#include "loop/clock.h"

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(WallClock, NeverWakesBeforeItsDeadline) {
  const WallClock clock;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t deadline_ns = WallClock::now_ns() + 300'000;
    clock.sleep_until(deadline_ns);
    EXPECT_GE(WallClock::now_ns(), deadline_ns);
  }
}

TEST(WallClock, ReturnsFromADeadlineThatHasPassed) {
  const WallClock clock;
  clock.sleep_until(WallClock::now_ns() - 1'000'000);
  clock.sleep_until(0);
}

TEST(VirtualClock, JumpsToItsDeadlineAndNeverBack) {
  VirtualClock clock;
  clock.sleep_until(5'000);
  EXPECT_EQ(clock.now_ns(), 5'000);
  clock.sleep_until(1'000);
  EXPECT_EQ(clock.now_ns(), 5'000);
}

}  // namespace
}  // namespace kerf::bench

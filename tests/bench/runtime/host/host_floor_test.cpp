#include "host/host_floor.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

TEST(HostFloor, BoundsTheMissesThatMayBeTheMachines) {
  // No miss in 3000 ticks: the rate is below 3 in 3000 with 95 % confidence ("rule of three": -ln 0.05).
  const HostFloor none{.ticks = 3000, .missed = 0};
  EXPECT_NEAR(none.max_expected(3000), 2.9957 + 3.0 * std::sqrt(2.9957), 1e-3);
  // 10 in 3000: the upper bound of a Poisson mean at 95 % is 16.962 (chi-square of 22 degrees of freedom, /
  // 2).
  const HostFloor ten{.ticks = 3000, .missed = 10};
  EXPECT_NEAR(ten.max_expected(3000), 16.962 + 3.0 * std::sqrt(16.962), 1e-3);
  EXPECT_EQ(HostFloor{}.max_expected(1000), 0.0);
}

TEST(HostFloor, IsThatOfAnEmptyLoopOnThisMachine) {
  const HostFloor floor = measure_host_floor(1000.0, 0.2);
  EXPECT_EQ(floor.ticks, 200U);
  EXPECT_LE(floor.wake.p50_us, floor.wake.p999_us);
  EXPECT_LE(floor.wake.p999_us, floor.wake.max_us);
  EXPECT_GT(floor.sleep.p50_us, 0.0) << "no sleeper wakes up at once";
  EXPECT_GE(floor.spin_ns, 10'000);
  EXPECT_LE(floor.spin_ns, 500'000) << "half a period at most";
  EXPECT_GE(static_cast<double>(floor.spin_ns), std::min(500e3, 1e3 * floor.sleep.p99_us))
      << "as early as 99 of 100 sleepers are late";
}

TEST(HostFloor, LeavesHalfOfAShortPeriodToSleep) {
  // A sleeper on any machine is later than the 12.5 us that half of this period lasts.
  EXPECT_LE(measure_host_floor(40'000.0, 0.02).spin_ns, 12'500);
}

TEST(HostFloor, IsKeptUntilTheMachineIsStartedAgain) {
  const test::TemporaryFolder folder;
  const char* const before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before != nullptr ? before : "";
  setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  EXPECT_FALSE(cached_host_floor(2000.0));
  const HostFloor first = host_floor(2000.0, 0.05);
  EXPECT_FALSE(first.from_cache);
  const HostFloor second = host_floor(2000.0, 0.05);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(second.spin_ns, first.spin_ns);
  EXPECT_EQ(second.missed, first.missed);
  EXPECT_EQ(second.wake.p999_us, first.wake.p999_us);
  EXPECT_FALSE(cached_host_floor(1000.0)) << "another rate has another floor";
  EXPECT_FALSE(host_floor(2000.0, 0.05, true).from_cache) << "wanted anew";

  const auto file = folder / "kerf/host-floor-2000Hz.json";
  std::string text = test::read_text(file);
  const auto key = text.find("\"key\": \"") + 8;
  text.replace(key, 4, "0000");
  test::write_text(file, text);
  EXPECT_FALSE(cached_host_floor(2000.0)) << "another start of the machine";
  test::write_text(file, "{ broken");
  EXPECT_FALSE(cached_host_floor(2000.0));
  before != nullptr ? setenv("XDG_CACHE_HOME", kept.c_str(), 1) : unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace kerf::bench

#include "loop/watchdog.h"

#include <gtest/gtest.h>

#include "loop/clock.h"

namespace kerf::bench {
namespace {

class ReleasedDevice final : public drivers::Device {
 public:
  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] drivers::Status read(double, drivers::Sample&) noexcept override {
    return drivers::Status::ok;
  }
  [[nodiscard]] drivers::Status write(const drivers::Axes&) noexcept override { return drivers::Status::ok; }
  void release(double at_s) noexcept override {
    released_at_s = at_s;
    ++releases;
  }
  std::atomic<double> released_at_s{0.0};
  std::atomic<int> releases{0};

 private:
  drivers::DeviceInfo info_;
};

constexpr std::int64_t ms = 1'000'000;

TEST(WatchdogLimit, IsTenMillisecondsOrThreePeriods) {
  EXPECT_EQ(watchdog_limit_ns(1e-4), 10 * ms);
  EXPECT_EQ(watchdog_limit_ns(1e-3), 10 * ms);
  EXPECT_EQ(watchdog_limit_ns(1e-2), 30 * ms) << "a loop at 100 Hz beats every 10 ms";
}

TEST(Heartbeat, ReleasesASilentDeviceOnceWhereItsTimeWasUp) {
  Heartbeat heartbeat;
  ReleasedDevice device;
  heartbeat.start(1000 * ms);
  EXPECT_FALSE(heartbeat.beat(1005 * ms, 10 * ms));
  EXPECT_FALSE(heartbeat.release_if_silent(device, 1015 * ms, 10 * ms));
  EXPECT_TRUE(heartbeat.release_if_silent(device, 1016 * ms, 10 * ms));
  EXPECT_FALSE(heartbeat.release_if_silent(device, 1017 * ms, 10 * ms));
  EXPECT_EQ(device.releases, 1);
  EXPECT_NEAR(device.released_at_s, 0.016, 1e-12);
  EXPECT_TRUE(heartbeat.beat(1018 * ms, 10 * ms)) << "the loop is told once";
  EXPECT_FALSE(heartbeat.beat(1019 * ms, 10 * ms));
  ASSERT_EQ(heartbeat.stalls().size(), 1U);
  EXPECT_EQ(heartbeat.stalls()[0].from_ns, 5 * ms);
  EXPECT_EQ(heartbeat.stalls()[0].silent_ns, 13 * ms);
  EXPECT_EQ(heartbeat.stalls()[0].released_after_ns, 11 * ms);
}

TEST(Heartbeat, SaysThatNobodyReleasedTheDeviceWhileTheWholeProcessStoodStill) {
  Heartbeat heartbeat;
  heartbeat.start(0);
  EXPECT_TRUE(heartbeat.beat(5000 * ms, 10 * ms));
  ASSERT_EQ(heartbeat.stalls().size(), 1U);
  EXPECT_EQ(heartbeat.stalls()[0].silent_ns, 5000 * ms);
  EXPECT_EQ(heartbeat.stalls()[0].released_after_ns, 0);
}

TEST(Heartbeat, AsksForZeroForceWhileItIsSuspendedAndOnceAfterAndCallsNoLaterStallASuspension) {
  Heartbeat heartbeat;
  heartbeat.start(0);
  EXPECT_FALSE(heartbeat.beat(1 * ms, 10 * ms));
  heartbeat.suspend();
  EXPECT_TRUE(heartbeat.beat(2 * ms, 10 * ms));
  EXPECT_TRUE(heartbeat.beat(3 * ms, 10 * ms));
  EXPECT_TRUE(heartbeat.stalls().empty()) << "the loop goes on until the process is stopped";
  heartbeat.resume();
  EXPECT_TRUE(heartbeat.beat(4003 * ms, 10 * ms)) << "the process stood still";
  EXPECT_FALSE(heartbeat.beat(4004 * ms, 10 * ms));
  EXPECT_TRUE(heartbeat.beat(4104 * ms, 10 * ms));
  ASSERT_EQ(heartbeat.stalls().size(), 2U);
  EXPECT_TRUE(heartbeat.stalls()[0].suspended);
  EXPECT_EQ(heartbeat.stalls()[0].silent_ns, 4000 * ms);
  EXPECT_FALSE(heartbeat.stalls()[1].suspended);
}

TEST(Heartbeat, OfALoopThatIsNotRunningIsNotMissed) {
  Heartbeat heartbeat;
  ReleasedDevice device;
  EXPECT_FALSE(heartbeat.release_if_silent(device, 1000 * ms, 10 * ms));
  heartbeat.start(0);
  heartbeat.stop();
  EXPECT_FALSE(heartbeat.release_if_silent(device, 1000 * ms, 10 * ms));
}

TEST(Watchdog, ReleasesADeviceWhoseLoopIsSilent) {
  Heartbeat heartbeat;
  ReleasedDevice device;
  const Watchdog watchdog(device, heartbeat, 1e-3);
  heartbeat.start(WallClock::now_ns());
  while (device.releases == 0) std::this_thread::yield();
  EXPECT_GT(device.released_at_s, 0.010);
  EXPECT_TRUE(heartbeat.beat(WallClock::now_ns(), 10 * ms));
}

}  // namespace
}  // namespace kerf::bench

#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include <kerf/drivers/triple_buffer.h>
#include <kerf/drivers/usb/io_thread.h>

namespace kerf::drivers {
namespace {

TEST(TripleBuffer, GivesTheNewestValueOnce) {
  TripleBuffer<int> latest;
  int value = -1;
  EXPECT_FALSE(latest.take(value));
  EXPECT_EQ(value, -1);
  for (int i = 1; i <= 10; ++i) latest.put(i);
  EXPECT_TRUE(latest.take(value));
  EXPECT_EQ(value, 10);
  EXPECT_FALSE(latest.take(value));
  latest.put(11);
  EXPECT_TRUE(latest.take(value));
  EXPECT_EQ(value, 11);
}

TEST(TripleBuffer, NeverGivesHalfOfOneAndHalfOfAnother) {
  struct Pair {
    std::uint64_t one = 0;
    std::uint64_t padding[30] = {};
    std::uint64_t two = 0;
  };
  TripleBuffer<Pair> latest;
  constexpr std::uint64_t last = 200'000;
  std::jthread producer([&] {
    for (std::uint64_t i = 1; i <= last; ++i) latest.put({.one = i, .two = i});
  });
  Pair pair;
  std::uint64_t before = 0;
  while (pair.one < last) {
    if (!latest.take(pair)) continue;
    ASSERT_EQ(pair.one, pair.two);
    ASSERT_GT(pair.one, before);
    before = pair.one;
  }
}

TEST(IoThread, IsWokenAndStops) {
  usb::IoThread thread;
  std::atomic<int> wakes{0};
  thread.start([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (thread.wait(std::int64_t{60'000'000'000})) ++wakes;
    }
  });
  thread.wake();
  while (wakes.load() == 0) std::this_thread::yield();
  thread.stop();  // returns at once, not after the minute
  EXPECT_GE(wakes.load(), 1);
}

}  // namespace
}  // namespace kerf::drivers

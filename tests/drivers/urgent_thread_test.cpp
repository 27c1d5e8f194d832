#include "kerf/drivers/urgent_thread.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

namespace kerf::drivers {
namespace {

TEST(Priorities, LieWithinTheLimitThatTheDocumentsGive) {
  for (std::uint64_t limit = 2; limit < 100; ++limit) {
    const Priorities both = priorities_within(limit);
    EXPECT_LT(both.loop, both.urgent);
    EXPECT_LE(both.urgent, static_cast<int>(limit));
    EXPECT_GE(both.loop, 1);
  }
  EXPECT_EQ(priorities_within(80).loop, 79) << "'rtprio 80' of docs/real-time.md";
  EXPECT_EQ(priorities_within(99).urgent, 80) << "below the kernel's own threads";
}

TEST(UrgentThread, IsOffTheLoopsProcessorAndSaysWhatItObtained) {
  std::jthread([] {
    become_urgent("kerf-test");
    cpu_set_t mine;
    CPU_ZERO(&mine);
    (void)sched_getaffinity(0, sizeof mine, &mine);
    EXPECT_TRUE(CPU_COUNT(&mine) == 1 || !CPU_ISSET(loop_processor(), &mine));
    const auto all = urgent_threads();
    const auto here = std::ranges::find(all, "kerf-test", &UrgentThread::name);
    ASSERT_NE(here, all.end());
    EXPECT_EQ(here->priority > 0, sched_getscheduler(0) == SCHED_FIFO);
  }).join();
}

}  // namespace
}  // namespace kerf::drivers

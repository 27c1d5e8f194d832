#include "fault_schedule.h"

#include <gtest/gtest.h>

namespace kerf::test {
namespace {

// Sanitizers make each some six times dearer.
#ifdef KERF_SANITIZED
constexpr std::uint64_t schedules = 2'000;
#else
constexpr std::uint64_t schedules = 10'000;
#endif

TEST(FaultSchedules, BreakNoPromise) {
  const std::vector<bench::LawFile> laws = every_law(KERF_SOURCE_DIR "/examples");
  ASSERT_GE(laws.size(), 18U);
  std::uint64_t with_force = 0;
  std::uint64_t ticks = 0;
  for (std::uint64_t seed = 1; seed <= schedules; ++seed) {
    const ScheduleOutcome outcome = run_schedule(seed, laws);
    EXPECT_EQ(outcome.violation, "");
    with_force += outcome.with_force;
    ticks += outcome.ticks;
    if (HasFailure() && seed > 200) break;
  }
  EXPECT_GT(with_force, ticks / 10) << "there was something to keep from the hand";
  RecordProperty("ticks", std::to_string(ticks));
  RecordProperty("with_force", std::to_string(with_force));
}

}  // namespace
}  // namespace kerf::test

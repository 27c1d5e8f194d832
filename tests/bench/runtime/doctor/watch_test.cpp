#include "doctor/watch/watch.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/drivers/urgent_thread.h>

#include "doctor/device_times.h"
#include "doctor/watch/observed.h"
#include "host/no_device.h"

// By the clock on the wall, since that is what is watched: nothing here says how long anything took.

namespace kerf::bench::doctor {
namespace {

using testing::HasSubstr;

/// A process that computes on the loop's processor for as long as the object lives.
class Hog {
 public:
  explicit Hog(const char* name) : pid_(fork()) {
    if (pid_ != 0) return;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(drivers::loop_processor(), &one);
    (void)sched_setaffinity(0, sizeof one, &one);
    (void)setpriority(PRIO_PROCESS, 0, -20);  // where that is permitted: others may be at work here too
    prctl(PR_SET_NAME, name);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (;;) {
    }
  }
  Hog(const Hog&) = delete;
  Hog& operator=(const Hog&) = delete;
  ~Hog() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  pid_t pid_;
};

Watched watch_empty_loop(double seconds, bool stop_at_once = false) {
  NoDevice nothing;
  const std::atomic<bool> stop{stop_at_once};
  std::atomic<std::size_t> done{0};
  return watch(HostTree(), nothing, {.rate_hz = 1000.0, .seconds = seconds}, stop, done);
}

TEST(DoctorWatches, AProcessThatTakesTheLoopsProcessorIsNamed) {
  const Hog hog("kerf-test-hog");
  // Where the machine is full of others the hog may get too little in one run.
  Watched watched = watch_empty_loop(0.8);
  for (int run = 1; run < 10 && other_processes(HostTree(), watched).state != State::costs; ++run)
    watched = watch_empty_loop(0.8);
  const Finding finding = other_processes(HostTree(), watched);
  EXPECT_EQ(finding.state, State::costs) << finding.seen;
  EXPECT_THAT(finding.seen, HasSubstr("kerf-test-hog (" + std::to_string(hog.pid()) + ")"));
  const auto& beside = watched.history.ran_beside;
  EXPECT_TRUE(std::ranges::any_of(beside, [&](const Task& task) { return task.pid == hog.pid(); }));
  EXPECT_FALSE(std::ranges::any_of(beside, [](const Task& task) { return task.pid == getpid(); }))
      << "what watches is not what is watched";
  EXPECT_THAT(finding.mend, HasSubstr("taskset"));
}

TEST(DoctorWatches, LoopAndSleeperHaveTheSameDeadlines) {
  const Watched watched = watch_empty_loop(0.3);
  EXPECT_EQ(watched.loop.ticks(), 300U);
  EXPECT_LE(watched.sleeper.ticks + watched.sleeper.missed, 300U);
  EXPECT_GT(watched.sleeper.ticks, 0U);
  EXPECT_EQ(watched.sleeper.wake.count(), watched.sleeper.ticks);
  EXPECT_GT(watched.cpu_share, 0.0);
  EXPECT_GE(watched.history.moments.size(), 2U) << "at the beginning and at the end";
  EXPECT_EQ(watched.late_us, 100.0) << "a tenth of a period";
}

TEST(DoctorWatches, EveryLateWakeUpIsLookedInto) {
  const Watched watched = watch_empty_loop(0.3);
  EXPECT_EQ(watched.explained.size(), std::min(watched.late_wakes, 2 * LateWakes::most));
  for (const ExplainedWake& one : watched.explained) {
    EXPECT_GT(1e-3 * static_cast<double>(one.wake.late_ns()), watched.late_us);
    EXPECT_FALSE(one.by.empty()) << "also of what is unknown it is said why";
  }
}

TEST(DoctorWatches, ALoopThatIsStoppedIsJudgedByWhatItDid) {
  const Watched watched = watch_empty_loop(3600.0, true);
  EXPECT_EQ(watched.loop.end, LoopEnd::stopped);
  EXPECT_GE(watched.loop.executed, 1U);
}

TEST(DoctorWatches, ADeviceIsTimedWithoutForce) {
  const auto device = drivers::open_device("sim:scissors");
  const std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0};
  const DeviceTimes times = time_device(HostTree(), *device, {.rate_hz = 1000.0, .seconds = 0.2}, stop, done);
  EXPECT_EQ(times.ticks, 200U);
  EXPECT_EQ(times.faults, 0U);
  EXPECT_EQ(times.age.count(), times.ticks - times.missed);
  EXPECT_GT(times.read.max_us, 0.0) << "it integrates its physics";
}

TEST(DoctorWatches, WhatDoesNotTellIsUnknown) {
  const Watched nothing;
  EXPECT_EQ(other_processes(HostTree("/nowhere"), nothing).state, State::unknown);
  EXPECT_EQ(interrupts(HostTree("/nowhere"), nothing).state, State::unknown);
  EXPECT_EQ(softirqs(nothing).state, State::unknown);
  EXPECT_EQ(steal_time(HostTree("/nowhere"), nothing).state, State::unknown);
  EXPECT_EQ(irq_balance(HostTree("/nowhere"), 3).state, State::unknown);
  EXPECT_EQ(load(HostTree("/nowhere")).state, State::unknown);
}

}  // namespace
}  // namespace kerf::bench::doctor

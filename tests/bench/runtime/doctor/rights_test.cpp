#include "doctor/facts/rights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/runtime/doctor/fake_tree.h"
#include "doctor/facts/cgroups.h"

namespace kerf::bench::doctor {
namespace {

using testing::HasSubstr;

constexpr const char* limits_of_a_user =
    "Limit                     Soft Limit           Hard Limit           Units     \n"
    "Max locked memory         8388608              8388608              bytes     \n"
    "Max nice priority         0                    0                    \n"
    "Max realtime priority     0                    0                    \n"
    "Max realtime timeout      unlimited            unlimited            us        ";

MachineTrials no_rights() {
  MachineTrials trials = test::all_permitted();
  trials.may_be_realtime = false;
  trials.realtime.reset();
  trials.realtime_detail = "ordinary scheduling, SCHED_FIFO refused: Operation not permitted";
  return trials;
}

TEST(DoctorRights, LimitsAndCapabilitiesAreReadAsTheKernelWritesThem) {
  EXPECT_EQ(limit_of(limits_of_a_user, "Max locked memory"), 8388608);
  EXPECT_EQ(limit_of(limits_of_a_user, "Max realtime timeout"), -1);
  EXPECT_FALSE(limit_of(limits_of_a_user, "Max of something"));
  // CAP_SYS_NICE is number 23.
  EXPECT_EQ(has_capability("Name:\tx\nCapEff:\t0000000000800000", 23), true);
  EXPECT_EQ(has_capability("CapEff:\t0000000000400000", 23), false);
  EXPECT_FALSE(has_capability("", 23));
}

TEST(DoctorRights, WithoutTheRightToRealTimeTheLimitIsNamed) {
  test::FakeTree fake;
  fake.file("/proc/self/limits", limits_of_a_user).file("/proc/self/status", "CapEff:\t0000000000000000");
  const Finding finding = realtime_scheduling(fake.tree(), no_rights());
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_THAT(finding.seen, HasSubstr("limit rtprio 0, nice 0, capability SYS_NICE no"));
  EXPECT_FALSE(finding.cost.us) << "nobody without the right can measure what it would bring";
  EXPECT_THAT(finding.mend, HasSubstr("/etc/security/limits.d"));
  EXPECT_EQ(memory_lock(fake.tree()).state, State::costs);
  EXPECT_EQ(realtime_scheduling(fake.tree(), test::all_permitted()).cost.us, 25.0);
}

TEST(DoctorRights, AProcessWithoutThemIsRefusedWhenItTries) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit none{.rlim_cur = 0, .rlim_max = 0};
    const bool dropped = setrlimit(RLIMIT_RTPRIO, &none) == 0 && (geteuid() != 0 || setuid(65534) == 0);
    _exit(dropped && !try_realtime().obtained ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(DoctorRights, AGroupWithoutRealTimeIsNamedInPlaceOfTheLimit) {
  test::FakeTree fake;
  fake.file("/proc/self/cgroup", "4:cpu,cpuacct:/docker/abc");
  fake.file("/sys/fs/cgroup/cpu,cpuacct/docker/abc/cpu.rt_runtime_us", "0");
  EXPECT_THAT(realtime_scheduling(fake.tree(), no_rights()).mend,
              HasSubstr("/sys/fs/cgroup/cpu,cpuacct/docker/abc/cpu.rt_runtime_us"));
}

TEST(DoctorRights, MemoryMayBeLockedByLimitOrCapability) {
  test::FakeTree fake;
  EXPECT_EQ(memory_lock(fake.tree()).state, State::unknown);
  fake.file("/proc/self/limits", limits_of_a_user);
  fake.file("/proc/self/status", "CapEff:\t0000000000004000");  // CAP_IPC_LOCK, number 14
  EXPECT_EQ(memory_lock(fake.tree()).state, State::good);
}

TEST(DoctorRights, ThrottlingOfRealTimeCostsALoopThatUsesMore) {
  test::FakeTree fake;
  const char* const file = "/proc/sys/kernel/sched_rt_runtime_us";
  fake.file(file, "950000").file("/proc/sys/kernel/sched_rt_period_us", "1000000");
  EXPECT_EQ(realtime_throttling(fake.tree(), 0.05).state, State::good);
  EXPECT_EQ(realtime_throttling(fake.tree(), 0.97).state, State::costs);
  EXPECT_THAT(realtime_throttling(fake.tree(), 0.97).cost.why, HasSubstr("50000 us in each 1000000 us"));
  EXPECT_EQ(realtime_throttling(fake.tree(), std::nullopt).state, State::unknown);
  fake.file(file, "-1");
  EXPECT_EQ(realtime_throttling(fake.tree(), 0.97).state, State::good);
  EXPECT_EQ(realtime_throttling(test::FakeTree().tree(), 0.05).state, State::unknown);
}

TEST(DoctorRights, AQuotaOfAGroupAboveCosts) {
  test::FakeTree fake;
  EXPECT_EQ(cgroup_quota(fake.tree(), std::nullopt).state, State::unknown);
  fake.file("/proc/self/cgroup", "0::/user.slice/kerf.scope");
  fake.file("/sys/fs/cgroup/user.slice/kerf.scope/cpu.max", "max 100000");
  EXPECT_EQ(cgroup_quota(fake.tree(), std::nullopt).state, State::good);
  fake.file("/sys/fs/cgroup/user.slice/cpu.max", "50000 100000");
  fake.file("/sys/fs/cgroup/user.slice/cpu.stat", "usage_usec 9\nnr_throttled 4\nthrottled_usec 120000");
  const Finding finding = cgroup_quota(fake.tree(), Throttled{.times = 4, .us = 120'000.0});
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_EQ(finding.where, "/sys/fs/cgroup/user.slice");
  EXPECT_EQ(finding.cost.us, 30'000.0) << "each time";
  EXPECT_THAT(finding.mend, HasSubstr("echo max | sudo tee /sys/fs/cgroup/user.slice/cpu.max"));
  ASSERT_TRUE(throttled_so_far(fake.tree()));
  EXPECT_EQ(throttled_so_far(fake.tree())->times, 4);
  EXPECT_EQ(throttled_so_far(fake.tree())->us, 120'000.0);
}

TEST(DoctorRights, AQuotaOfVersionOneCostsToo) {
  test::FakeTree fake;
  fake.file("/proc/self/cgroup", "3:cpuset:/\n1:cpu,cpuacct:/box\n0::/");
  fake.file("/sys/fs/cgroup/cpu,cpuacct/box/cpu.cfs_quota_us", "20000");
  fake.file("/sys/fs/cgroup/cpu,cpuacct/box/cpu.cfs_period_us", "100000");
  EXPECT_THAT(cgroup_quota(fake.tree(), std::nullopt).seen, HasSubstr("0.20 processors"));
  fake.file("/sys/fs/cgroup/cpu,cpuacct/box/cpu.cfs_quota_us", "-1");
  EXPECT_EQ(cgroup_quota(fake.tree(), std::nullopt).state, State::good);
}

TEST(DoctorRights, OneProcessorForAllCosts) {
  test::FakeTree fake;
  fake.file("/sys/devices/system/cpu/online", "0-3");
  fake.file("/proc/self/status", "Cpus_allowed:\t4\nCpus_allowed_list:\t2");
  EXPECT_EQ(cpuset(fake.tree()).state, State::costs);
  EXPECT_THAT(cpuset(fake.tree()).mend, HasSubstr("taskset -c 0-3"));
  fake.file("/proc/self/status", "Cpus_allowed_list:\t0-3");
  EXPECT_EQ(cpuset(fake.tree()).state, State::good);
  EXPECT_EQ(cpuset(test::FakeTree().tree()).state, State::unknown);
}

TEST(DoctorRights, ASlackThatWasHandedDownIsNamedAndMeasured) {
  const int before = prctl(PR_GET_TIMERSLACK);
  prctl(PR_SET_TIMERSLACK, 2'000'000UL);
  const MachineTrials trials = run_trials(20);
  prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(before));
  const Finding finding = timer_slack(trials);
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_THAT(finding.seen, HasSubstr("2000000 ns"));
  EXPECT_TRUE(finding.cost.us) << "measured";
  EXPECT_THAT(finding.mend, HasSubstr("timerslack_ns"));
}

TEST(DoctorRights, TheUsualSlackIsGoodSinceTheLoopAsksForLess) {
  const Finding finding = timer_slack(test::all_permitted());
  EXPECT_EQ(finding.state, State::good);
  EXPECT_EQ(finding.cost.us, 50.0);
}

}  // namespace
}  // namespace kerf::bench::doctor

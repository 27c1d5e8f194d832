#include "doctor/facts/processors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/runtime/doctor/fake_tree.h"

namespace kerf::bench::doctor {
namespace {

using testing::HasSubstr;

constexpr const char* governor_file = "/sys/devices/system/cpu/cpu3/cpufreq/scaling_governor";

TEST(DoctorProcessors, ASavingGovernorCostsWhatAComputationTakesLongerAfterASleep) {
  test::FakeTree fake;
  fake.file(governor_file, "powersave");
  const Finding finding = frequency_governor(fake.tree(), 3, test::all_permitted());
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_THAT(finding.seen, HasSubstr("powersave"));
  EXPECT_EQ(finding.where, governor_file);
  EXPECT_EQ(finding.cost.us, 30.0);
  EXPECT_EQ(finding.mend, "sudo cpupower frequency-set -g performance");
}

TEST(DoctorProcessors, AGovernorForPerformanceIsGood) {
  test::FakeTree fake;
  fake.file(governor_file, "performance");
  EXPECT_EQ(frequency_governor(fake.tree(), 3, test::all_permitted()).state, State::good);
}

TEST(DoctorProcessors, AGovernorThatIsNotOfferedCannotBeAdvised) {
  test::FakeTree fake;
  fake.file(governor_file, "schedutil");
  fake.file("/sys/devices/system/cpu/cpu3/cpufreq/scaling_available_governors", "schedutil ondemand");
  EXPECT_THAT(frequency_governor(fake.tree(), 3, test::all_permitted()).mend,
              testing::AllOf(HasSubstr("none here"), HasSubstr("schedutil ondemand")));
}

TEST(DoctorProcessors, WhereNoGovernorIsToBeSeenThatIsSaid) {
  const test::FakeTree nothing;
  const Finding finding = frequency_governor(nothing.tree(), 3, test::all_permitted());
  EXPECT_EQ(finding.state, State::unknown);
  EXPECT_THAT(finding.seen, HasSubstr("cannot be seen or set here"));
  EXPECT_FALSE(finding.cost.us);
}

void add_idle_states(test::FakeTree& fake) {
  const std::string folder = "/sys/devices/system/cpu/cpu3/cpuidle/";
  fake.file(folder + "state0/name", "POLL").file(folder + "state0/latency", "0");
  fake.file(folder + "state1/name", "C1").file(folder + "state1/latency", "2");
  fake.file(folder + "state2/name", "C6").file(folder + "state2/latency", "133");
  fake.file(folder + "state3/name", "C8")
      .file(folder + "state3/latency", "600")
      .file(folder + "state3/disable", "1");
}

TEST(DoctorProcessors, DeepSleepCostsWhoMayNotHoldItOff) {
  test::FakeTree fake;
  add_idle_states(fake);
  MachineTrials trials = test::all_permitted();
  EXPECT_EQ(idle_states(fake.tree(), 3, trials).state, State::good) << "the loop holds it off";
  EXPECT_EQ(idle_states(fake.tree(), 3, trials).cost.us, 10.0);
  trials.may_stay_awake = false;
  trials.awake.reset();
  trials.awake_detail = "/dev/cpu_dma_latency: Permission denied";
  const Finding finding = idle_states(fake.tree(), 3, trials);
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_THAT(finding.seen, testing::AllOf(HasSubstr("C6, 133 us"), HasSubstr("Permission denied")));
  EXPECT_FALSE(finding.cost.us) << "not measured";
  EXPECT_THAT(finding.cost.why, HasSubstr("133 us"));
  EXPECT_THAT(finding.mend, HasSubstr("90-kerf-latency.rules"));
  EXPECT_EQ(idle_states(test::FakeTree().tree(), 3, trials).state, State::unknown);
}

TEST(DoctorProcessors, ABusySiblingCosts) {
  test::FakeTree fake;
  fake.file("/sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "1,3");
  fake.file("/sys/devices/system/cpu/smt/control", "on");
  EXPECT_THAT(siblings_of(fake.tree(), 3), testing::ElementsAre(1));
  EXPECT_EQ(smt_siblings(fake.tree(), 3, 0.4).state, State::costs);
  EXPECT_THAT(smt_siblings(fake.tree(), 3, 0.4).mend, HasSubstr("/sys/devices/system/cpu/smt/control"));
  EXPECT_EQ(smt_siblings(fake.tree(), 3, 0.01).state, State::good);
  EXPECT_EQ(smt_siblings(fake.tree(), 3, std::nullopt).state, State::unknown);
  EXPECT_EQ(smt_siblings(test::FakeTree().tree(), 3, 0.4).state, State::unknown);
}

TEST(DoctorProcessors, HeatIsCountedOverTheRun) {
  test::FakeTree fake;
  EXPECT_FALSE(thermal_throttle_count(fake.tree()));
  fake.file("/sys/devices/system/cpu/cpu0/thermal_throttle/core_throttle_count", "4");
  fake.file("/sys/devices/system/cpu/cpu1/thermal_throttle/package_throttle_count", "3");
  EXPECT_EQ(thermal_throttle_count(fake.tree()), 7);
  EXPECT_EQ(thermal_throttling(7, 7).state, State::good);
  EXPECT_EQ(thermal_throttling(7, 9).state, State::costs);
  EXPECT_THAT(thermal_throttling(7, 9).seen, HasSubstr("2 times in the run"));
  EXPECT_EQ(thermal_throttling(std::nullopt, std::nullopt).state, State::unknown);
}

}  // namespace
}  // namespace kerf::bench::doctor

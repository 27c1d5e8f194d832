#include "doctor/watch/observed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/runtime/doctor/fake_tree.h"

namespace kerf::bench::doctor {
namespace {

using testing::HasSubstr;

/// A second on processor 3.
Watched second_of(std::uint64_t interrupts, double steal_us) {
  Watched watched;
  watched.processor = 3;
  watched.late_us = 100.0;
  const auto moment = [](std::int64_t at_ns, std::uint64_t count, double stolen_us, double softirq_us) {
    return Moment{.at_ns = at_ns,
                  .times = ProcessorTimes{.total_us = 1e-3 * static_cast<double>(at_ns),
                                          .softirq_us = softirq_us,
                                          .steal_us = stolen_us},
                  .interrupts = {{.name = "36 disk", .count = count}, {.name = "LOC timer", .count = count}},
                  .throttled = std::nullopt};
  };
  watched.history.moments = {moment(0, 0, 0.0, 0.0), moment(1'000'000'000, interrupts, steal_us, 30'000.0)};
  return watched;
}

TEST(DoctorObserves, InterruptsThatMadeNothingLateAreGood) {
  const Finding finding = interrupts(test::FakeTree().tree(), second_of(200, 0.0));
  EXPECT_EQ(finding.state, State::good);
  EXPECT_THAT(finding.seen, HasSubstr("200 a second on processor 3")) << "without the timer's";
  EXPECT_FALSE(finding.cost.us);
}

TEST(DoctorObserves, InterruptsOfADeviceCanBeSentElsewhere) {
  test::FakeTree fake;
  fake.file("/sys/devices/system/cpu/online", "0-3");
  Watched watched = second_of(5000, 0.0);
  watched.explained = {
      {.wake = {.due_ns = 0, .woken_ns = 400'000}, .cause = WakeCause::interrupts, .by = ""}};
  const Finding finding = interrupts(fake.tree(), watched);
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_EQ(finding.cost.us, 400.0);
  EXPECT_EQ(finding.mend, "echo 0-2 | sudo tee /proc/irq/36/smp_affinity_list");
}

TEST(DoctorObserves, WhoMadeWakeUpsLateIsNamedBeforeWhoRanMost) {
  test::FakeTree fake;
  fake.file("/sys/devices/system/cpu/online", "0-3");
  Watched watched = second_of(0, 0.0);
  watched.history.tasks = {{.from_ns = 0, .until_ns = 1'000'000'000, .ran = {}}};
  watched.history.ran_beside = {{.pid = 7, .tid = 7, .name = "patient", .processor = 3, .run_us = 900'000.0}};
  EXPECT_EQ(other_processes(fake.tree(), watched).state, State::costs) << "it takes nine tenths";
  EXPECT_EQ(other_processes(fake.tree(), watched).mend,
            "ps -fp 7   # then end it, or keep it off: taskset -acp 0-2 7");
  const LateWake late{.due_ns = 0, .woken_ns = 3'000'000};
  watched.explained = {{.wake = late, .cause = WakeCause::process, .by = "hog (42)", .pid = 42},
                       {.wake = late, .cause = WakeCause::process, .by = "hog (42)", .pid = 42}};
  const Finding finding = other_processes(fake.tree(), watched);
  EXPECT_THAT(finding.seen,
              testing::StartsWith("hog (42) made 2 wake-ups late; on the loop's processor 3: patient"));
  EXPECT_EQ(finding.cost.us, 3'000.0);
  EXPECT_THAT(finding.mend, HasSubstr("taskset -acp 0-2 42"));
}

TEST(DoctorObserves, IrqbalanceMayBeKeptOffTheLoopsProcessor) {
  test::FakeTree fake;
  fake.file("/proc/7/comm", "cron");
  EXPECT_EQ(irq_balance(fake.tree(), 3).state, State::good);
  fake.file("/proc/8/comm", "irqbalance");
  EXPECT_EQ(irq_balance(fake.tree(), 3).state, State::costs);
  EXPECT_THAT(irq_balance(fake.tree(), 3).mend, HasSubstr("IRQBALANCE_BANNED_CPULIST=3"));
  fake.file("/etc/default/irqbalance", "# settings\nIRQBALANCE_BANNED_CPULIST=\"2-3\"");
  EXPECT_EQ(irq_balance(fake.tree(), 3).state, State::good);
}

TEST(DoctorObserves, StolenTimeCosts) {
  test::FakeTree fake;
  fake.file("/proc/cpuinfo", "flags\t\t: fpu hypervisor lahf_lm");
  EXPECT_EQ(steal_time(fake.tree(), second_of(0, 20'000.0)).state, State::costs);
  EXPECT_EQ(steal_time(fake.tree(), second_of(0, 0.0)).state, State::unknown)
      << "a hypervisor that has told of none may tell of none ever";
  test::FakeTree machine;
  machine.file("/proc/cpuinfo", "flags\t\t: fpu lahf_lm");
  EXPECT_EQ(steal_time(machine.tree(), second_of(0, 0.0)).state, State::good);
}

TEST(DoctorObserves, SoftirqsCostByTheirShare) {
  EXPECT_EQ(softirqs(second_of(0, 0.0)).state, State::costs) << "30 ms of a second";
  Watched watched = second_of(0, 0.0);
  watched.history.moments[1].times->softirq_us = 1'000.0;
  EXPECT_EQ(softirqs(watched).state, State::good);
}

TEST(DoctorObserves, MoreThreadsThanProcessorsCost) {
  test::FakeTree fake;
  fake.file("/proc/loadavg", "0.00 0.01 0.05 1/123 4567");
  EXPECT_EQ(load(fake.tree()).state, State::good);
  fake.file("/proc/loadavg", "9000.5 0.01 0.05 1/123 4567");
  EXPECT_EQ(load(fake.tree()).state, State::costs);
}

TEST(DoctorObserves, OnlyPagesOfADiskCost) {
  Watched watched;
  watched.usage.page_faults = 3;
  EXPECT_EQ(page_faults(watched).state, State::good);
  watched.usage.major_page_faults = 1;
  EXPECT_EQ(page_faults(watched).state, State::costs);
}

}  // namespace
}  // namespace kerf::bench::doctor

#include "doctor/facts/kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/runtime/doctor/fake_tree.h"

namespace kerf::bench::doctor {
namespace {

using testing::HasSubstr;

constexpr const char* clock_file = "/sys/devices/system/clocksource/clocksource0/current_clocksource";

TEST(DoctorKernel, AClockOfAChipCosts) {
  for (const char* const chip : {"hpet", "acpi_pm", "jiffies"}) {
    test::FakeTree fake;
    fake.file(clock_file, chip);
    fake.file("/sys/devices/system/clocksource/clocksource0/available_clocksource", "tsc hpet acpi_pm");
    MachineTrials trials = test::all_permitted();
    trials.clock_read_us = 1.2;
    const Finding finding = clock_source(fake.tree(), trials);
    EXPECT_EQ(finding.state, State::costs) << chip;
    EXPECT_EQ(finding.cost.us, 1.2);
    EXPECT_EQ(finding.mend, std::string("echo tsc | sudo tee ") + clock_file);
  }
}

TEST(DoctorKernel, AClockOfTheProcessorIsGoodIfItIsFast) {
  test::FakeTree fake;
  fake.file(clock_file, "kvm-clock");
  MachineTrials trials = test::all_permitted();
  EXPECT_EQ(clock_source(fake.tree(), trials).state, State::good);
  trials.clock_read_us = 0.8;  // where every reading is a system call
  EXPECT_EQ(clock_source(fake.tree(), trials).state, State::costs);
  EXPECT_THAT(clock_source(fake.tree(), trials).mend, HasSubstr("tsc=reliable"));
  EXPECT_EQ(clock_source(test::FakeTree().tree(), trials).state, State::unknown);
}

TEST(DoctorKernel, AHypervisorIsTold) {
  test::FakeTree flagged;
  flagged.file("/proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu tsc hypervisor lahf_lm");
  const Finding finding = virtual_machine(flagged.tree(), 3200.0);
  EXPECT_EQ(finding.state, State::costs);
  EXPECT_EQ(finding.cost.us, 3200.0);
  EXPECT_THAT(finding.mend, HasSubstr("vcpupin"));

  test::FakeTree named;
  named.file("/proc/cpuinfo", "processor\t: 0\nFeatures\t: fp asimd");
  named.file("/sys/class/dmi/id/product_name", "KVM Virtual Machine");
  EXPECT_EQ(virtual_machine(named.tree(), std::nullopt).state, State::costs);
  EXPECT_THAT(virtual_machine(named.tree(), std::nullopt).seen, HasSubstr("KVM Virtual Machine"));
}

TEST(DoctorKernel, AMachineOfItsOwnIsGood) {
  test::FakeTree fake;
  fake.file("/proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu tsc");
  fake.file("/sys/class/dmi/id/sys_vendor", "Dell Inc.");
  EXPECT_EQ(virtual_machine(fake.tree(), 3200.0).state, State::good);
  EXPECT_FALSE(virtual_machine(fake.tree(), 3200.0).cost.us);
  EXPECT_EQ(virtual_machine(test::FakeTree().tree(), 3200.0).state, State::unknown);
}

TEST(DoctorKernel, OnlyPreemptRtIsGood) {
  test::FakeTree rt;
  rt.file("/sys/kernel/realtime", "1");
  EXPECT_EQ(preemption(rt.tree()).state, State::good);
  test::FakeTree dynamic;
  dynamic.file("/proc/version", "Linux version 6.1.0 #1 SMP PREEMPT_DYNAMIC Debian 6.1.0-1");
  EXPECT_EQ(preemption(dynamic.tree()).state, State::costs);
  EXPECT_THAT(preemption(dynamic.tree()).mend, HasSubstr("linux-image-rt"));
  test::FakeTree none;
  none.file("/proc/version", "Linux version 6.1.0 #1 SMP Debian 6.1.0-1");
  EXPECT_EQ(preemption(none.tree()).state, State::unknown) << "nothing tells";
  none.file("/proc/sys/kernel/osrelease", "6.1.0-1-amd64");
  none.file("/boot/config-6.1.0-1-amd64",
            "CONFIG_HZ=250\n# CONFIG_PREEMPT is not set\nCONFIG_PREEMPT_NONE=y");
  EXPECT_THAT(preemption(none.tree()).seen, HasSubstr("PREEMPT_NONE"));
  EXPECT_EQ(kernel_option(none.tree(), "CONFIG_PREEMPT"), "n");
  EXPECT_EQ(kernel_option(none.tree(), "CONFIG_HZ"), "250");
  EXPECT_FALSE(kernel_option(test::FakeTree().tree(), "CONFIG_HZ"));
}

TEST(DoctorKernel, AProcessorOfItsOwnIsGood) {
  test::FakeTree fake;
  fake.file("/proc/cmdline", "quiet isolcpus=2-3 nohz_full=2-3")
      .file("/sys/devices/system/cpu/isolated", "2-3");
  EXPECT_EQ(isolated_processor(fake.tree(), 3).state, State::good);
  EXPECT_THAT(isolated_processor(fake.tree(), 3).seen, HasSubstr("nohz_full=2-3 rcu_nocbs=-"));
  EXPECT_THAT(isolated_processor(fake.tree(), 1).mend, HasSubstr("taskset -c 0,2-3"));
  fake.file("/sys/devices/system/cpu/isolated", "").file("/sys/devices/system/cpu/online", "0-3");
  EXPECT_EQ(isolated_processor(fake.tree(), 3).state, State::costs);
  EXPECT_THAT(isolated_processor(fake.tree(), 3).mend,
              HasSubstr("isolcpus=3 nohz_full=3 rcu_nocbs=3 irqaffinity=0-2"));
  EXPECT_EQ(isolated_processor(test::FakeTree().tree(), 3).state, State::unknown);
}

TEST(DoctorKernel, MemoryThatMayGoToADiskCostsWhoCannotLockIt) {
  test::FakeTree fake;
  fake.file("/proc/swaps", "Filename Type Size Used Priority\n/dev/sda2 partition 8 0 -2");
  EXPECT_EQ(swap(fake.tree(), false).state, State::costs);
  EXPECT_EQ(swap(fake.tree(), true).state, State::good);
  fake.file("/proc/swaps", "Filename Type Size Used Priority");
  EXPECT_EQ(swap(fake.tree(), false).state, State::good);
  EXPECT_EQ(swap(test::FakeTree().tree(), true).state, State::unknown);
}

TEST(DoctorKernel, ShortMemoryCosts) {
  test::FakeTree fake;
  fake.file("/proc/sys/vm/overcommit_memory", "0");
  fake.file("/proc/meminfo", "MemTotal:       16384000 kB\nMemFree: 1 kB\nMemAvailable:     512000 kB");
  EXPECT_EQ(memory_left(fake.tree()).state, State::costs) << "3 %";
  EXPECT_THAT(memory_left(fake.tree()).seen, HasSubstr("500 of 16000 MB, overcommit_memory 0"));
  fake.file("/proc/meminfo", "MemTotal:       16384000 kB\nMemAvailable:    8192000 kB");
  EXPECT_EQ(memory_left(fake.tree()).state, State::good);
  EXPECT_EQ(memory_left(test::FakeTree().tree()).state, State::unknown);
}

TEST(DoctorKernel, HugePagesForAllCost) {
  test::FakeTree fake;
  const char* const file = "/sys/kernel/mm/transparent_hugepage/enabled";
  fake.file(file, "[always] madvise never");
  EXPECT_EQ(huge_pages(fake.tree()).state, State::costs);
  fake.file(file, "always [madvise] never");
  EXPECT_EQ(huge_pages(fake.tree()).state, State::good);
  EXPECT_EQ(huge_pages(test::FakeTree().tree()).state, State::unknown);
}

}  // namespace
}  // namespace kerf::bench::doctor

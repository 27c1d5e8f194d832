#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/runtime/doctor/fake_tree.h"
#include "doctor/watch/counters.h"
#include "doctor/watch/tasks.h"

namespace kerf::bench::doctor {
namespace {

constexpr const char* interrupt_table =
    "           CPU0       CPU2       \n"
    " 26:          0         10  IO-APIC   4-edge      ttyS0\n"
    " 36:          7      91637 PCI-MSIX-0000:00:02.0   1-edge      virtio1-req.0\n"
    "LOC:     428651     411002   Local timer interrupts\n"
    "ERR:          0";

TEST(DoctorCounters, InterruptsAreThoseOfOneProcessor) {
  const auto counts = interrupts_of(interrupt_table, 2);
  ASSERT_EQ(counts.size(), 3U) << "ERR belongs to none";
  EXPECT_EQ(counts[1].name, "36 virtio1-req.0");
  EXPECT_EQ(counts[1].count, 91637U);
  EXPECT_EQ(counts[2].name, "LOC Local timer interrupts");
  EXPECT_TRUE(is_timer(counts[2]));
  EXPECT_EQ(interrupts_of(interrupt_table, 0)[1].count, 7U);
  EXPECT_THAT(interrupts_of(interrupt_table, 1), testing::IsEmpty()) << "it is not online";
}

TEST(DoctorCounters, WhatGrewMostComesFirst) {
  const std::vector<Count> before{
      {.name = "a", .count = 5}, {.name = "b", .count = 5}, {.name = "c", .count = 5}};
  const std::vector<Count> after{
      {.name = "a", .count = 6}, {.name = "b", .count = 9}, {.name = "c", .count = 5}};
  const auto grown = growth(before, after);
  ASSERT_EQ(grown.size(), 2U);
  EXPECT_EQ(grown[0].name, "b");
  EXPECT_EQ(grown[0].count, 4U);
}

TEST(DoctorCounters, SoftirqsAreThoseOfOneProcessor) {
  const auto counts = softirqs_of("        CPU0   CPU1\n  HI:   0   1\n  NET_RX:  20  30", 1);
  ASSERT_EQ(counts.size(), 2U);
  EXPECT_EQ(counts[1].name, "NET_RX");
  EXPECT_EQ(counts[1].count, 30U);
}

TEST(DoctorCounters, TimesAreThoseOfTheKernelsTicks) {
  const auto times =
      processor_times("cpu  1 2 3 4\ncpu0 10 0 20 60 5 1 2 3 4 0\ncpu1 0 0 0 0 0 0 0 0 0 0", 0, 100);
  ASSERT_TRUE(times);
  EXPECT_EQ(times->idle_us, 650'000.0);
  EXPECT_EQ(times->interrupt_us, 10'000.0);
  EXPECT_EQ(times->softirq_us, 20'000.0);
  EXPECT_EQ(times->steal_us, 30'000.0);
  EXPECT_EQ(times->total_us, 1'010'000.0) << "guests' time is within that of user";
  EXPECT_FALSE(processor_times("cpu0 10 0 20", 0, 100));
  EXPECT_FALSE(processor_times("", 0, 100));
}

constexpr const char* odd_name =
    "4211 (a) (b) R 1 4211 1 0 -1 4194304 99 0 0 0 250 50 0 0 20 0 1 0 57854 3133440 387 "
    "18446744073709551615 1 1 1 "
    "0 0 0 0 0 0 0 0 0 17 3 99 1 0 0 0";

TEST(DoctorTasks, AThreadIsReadAsTheKernelWritesIt) {
  const auto task = task_of(odd_name, 100);
  ASSERT_TRUE(task);
  EXPECT_EQ(task->tid, 4211);
  EXPECT_EQ(task->name, "a) (b");
  EXPECT_EQ(task->processor, 3);
  EXPECT_EQ(task->rt_priority, 99);
  EXPECT_EQ(task->run_us, 3'000'000.0);
  EXPECT_FALSE(task_of("4211 (short) R 1", 100));
  EXPECT_FALSE(task_of("", 100));
}

TEST(DoctorTasks, AScanSeesThreadsOfOthersToTheNanosecond) {
  test::FakeTree fake;
  fake.file("/proc/4211/task/4211/stat", odd_name).file("/proc/4211/task/4211/schedstat", "3004005006 7 8");
  fake.file("/proc/99/task/99/stat", odd_name).file("/proc/uptime", "1 1");
  const auto tasks = scan_tasks(fake.tree(), 99);
  ASSERT_EQ(tasks.size(), 1U);
  EXPECT_EQ(tasks[0].pid, 4211);
  EXPECT_EQ(tasks[0].run_us, 3'004'005.006);
}

TEST(DoctorTasks, WhoRanIsWhoseTimeGrew) {
  const std::vector<Task> before{{.pid = 1, .tid = 1, .run_us = 10.0}, {.pid = 2, .tid = 2, .run_us = 10.0}};
  const std::vector<Task> after{{.pid = 1, .tid = 1, .run_us = 10.0},
                                {.pid = 2, .tid = 2, .run_us = 15.0},
                                {.pid = 3, .tid = 3, .run_us = 7.0}};
  const auto ran = ran_between(before, after);
  ASSERT_EQ(ran.size(), 2U);
  EXPECT_EQ(ran[0].pid, 3) << "it has begun meanwhile";
  EXPECT_EQ(ran[1].run_us, 5.0);
}

}  // namespace
}  // namespace kerf::bench::doctor

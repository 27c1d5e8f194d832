#include "doctor/watch/explain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "doctor/watch/observed.h"

namespace kerf::bench::doctor {
namespace {

using testing::HasSubstr;

/// 3 ms late, 100 ms after the first look.
LateWake spike(std::int64_t run_delay_ns) {
  return {.due_ns = 100'000'000,
          .woken_ns = 103'000'000,
          .run_delay_ns = run_delay_ns,
          .usage = {},
          .is_loop = true};
}
constexpr std::int64_t waited_ns = 2'900'000;
constexpr std::int64_t not_waited_ns = 4'000;

Task hog(double run_us) {
  return {.pid = 42, .tid = 42, .name = "hog", .processor = 3, .rt_priority = 99, .run_us = run_us};
}

Moment at(std::int64_t ms, double steal_us, std::uint64_t disk_interrupts) {
  return {.at_ns = 1'000'000 * ms,
          .times = ProcessorTimes{.steal_us = steal_us},
          .interrupts = {{.name = "36 disk", .count = disk_interrupts},
                         {.name = "LOC timer", .count = 10'000 + static_cast<std::uint64_t>(ms)}},
          .throttled = Throttled{}};
}

History quiet() {
  return {.moments = {at(0, 0.0, 0), at(90, 0.0, 90), at(110, 0.0, 110), at(1000, 0.0, 1000)},
          .tasks = {{.from_ns = 0, .until_ns = 105'000'000, .ran = {}}},
          .ran_anywhere = {},
          .ran_beside = {},
          .softirqs = {}};
}

ExplainedWake explained(const LateWake& wake, const History& history,
                        const std::vector<LateWake>& witness = {}) {
  return explain(wake, evidence_for(wake, history, witness));
}

TEST(DoctorExplains, WhoeverHadToWaitWaitedForWhoRanThere) {
  History history = quiet();
  history.tasks.front().ran = {hog(3'000.0)};
  const ExplainedWake one = explained(spike(waited_ns), history);
  EXPECT_EQ(one.cause, WakeCause::process);
  EXPECT_EQ(one.by, "hog (42) at real-time priority 99");
}

TEST(DoctorExplains, AProcessThatRanTooLittleIsNotAccused) {
  History history = quiet();
  history.tasks.front().ran = {hog(1'000.0)};
  EXPECT_EQ(explained(spike(waited_ns), history).cause, WakeCause::unknown);
}

TEST(DoctorExplains, AMoreUrgentProcessComesBeforeOneThatRanLonger) {
  LateWake wake = spike(waited_ns);
  wake.priority = 79;
  Task patient{.pid = 7, .tid = 7, .name = "patient", .processor = 3, .rt_priority = 0, .run_us = 90'000.0};
  History history = quiet();
  history.tasks.front().ran = {patient, hog(3'000.0)};
  EXPECT_EQ(explained(wake, history).by, "hog (42) at real-time priority 99");
  history.tasks.front().ran = {patient, hog(1'000.0)};  // too little to have been it
  EXPECT_EQ(explained(wake, history).by, "patient (7)");
}

TEST(DoctorExplains, AProcessIsNotAccusedOfATimerThatCameLate) {
  History history = quiet();
  history.tasks.front().ran = {hog(100'000.0)};
  EXPECT_EQ(explained(spike(not_waited_ns), history).cause, WakeCause::unknown);
  EXPECT_EQ(explained(spike(-1), history).cause, WakeCause::unknown) << "the kernel does not tell";
}

TEST(DoctorExplains, AProcessOfAnotherTimeIsNotAccused) {
  History history = quiet();
  history.tasks.front() = {.from_ns = 200'000'000, .until_ns = 300'000'000, .ran = {hog(3'000.0)}};
  EXPECT_EQ(explained(spike(waited_ns), history).cause, WakeCause::unknown);
}

TEST(DoctorExplains, AGroupThatWasHeldBackComesBeforeWhoRanMeanwhile) {
  History history = quiet();
  history.tasks.front().ran = {hog(3'000.0)};
  history.moments[2].throttled = Throttled{.times = 1, .us = 3'000.0};
  EXPECT_EQ(explained(spike(waited_ns), history).cause, WakeCause::throttled);
}

TEST(DoctorExplains, PagesOfADiskComeFirst) {
  LateWake wake = spike(waited_ns);
  wake.usage.major_page_faults = 2;
  History history = quiet();
  history.tasks.front().ran = {hog(3'000.0)};
  EXPECT_EQ(explained(wake, history).cause, WakeCause::page_fault);
}

TEST(DoctorExplains, WhatAHypervisorToldOfIsItsDoing) {
  History history = quiet();
  history.moments[2].times->steal_us = 10'000.0;
  EXPECT_EQ(explained(spike(not_waited_ns), history).cause, WakeCause::steal);
  EXPECT_EQ(explained(spike(waited_ns), history).cause, WakeCause::steal) << "nobody else ran there";
  History later = quiet();
  later.moments[3].times->steal_us = 10'000.0;
  EXPECT_EQ(explained(spike(not_waited_ns), later).cause, WakeCause::unknown) << "it was at another time";
}

TEST(DoctorExplains, AnotherProcessorThatStoodStillMeansTheMachine) {
  LateWake other = spike(not_waited_ns);
  other.due_ns += 1'000'000;
  EXPECT_EQ(explained(spike(not_waited_ns), quiet(), {other}).cause, WakeCause::stood_still);
  other.due_ns += 1'000'000;  // one of three milliseconds together
  EXPECT_EQ(explained(spike(not_waited_ns), quiet(), {other}).cause, WakeCause::unknown);
}

TEST(DoctorExplains, AStormOfInterruptsIsTheirDoing) {
  History history = quiet();
  for (std::size_t after = 2; after < 4; ++after) history.moments[after].interrupts[0].count += 5'000;
  const ExplainedWake one = explained(spike(not_waited_ns), history);
  EXPECT_EQ(one.cause, WakeCause::interrupts);
  EXPECT_THAT(one.by, HasSubstr("36 disk"));
  History few = quiet();
  for (std::size_t after = 2; after < 4; ++after) few.moments[after].interrupts[0].count += 200;
  EXPECT_EQ(explained(spike(not_waited_ns), few).cause, WakeCause::unknown)
      << "200 of 10 us each do not make 3 ms";
}

TEST(DoctorExplains, NothingSeenIsUnknown) {
  EXPECT_EQ(explained(spike(not_waited_ns), quiet()).cause, WakeCause::unknown);
  EXPECT_EQ(explained(spike(waited_ns), History{}).cause, WakeCause::unknown);
}

TEST(DoctorExplains, TheCostOfACauseIsItsLongestLateness) {
  LateWake longer = spike(not_waited_ns);
  longer.woken_ns += 500'000;
  const std::vector<ExplainedWake> wakes{{.wake = spike(not_waited_ns), .cause = WakeCause::steal, .by = ""},
                                         {.wake = longer, .cause = WakeCause::steal, .by = ""},
                                         {.wake = longer, .cause = WakeCause::unknown, .by = ""}};
  EXPECT_EQ(longest_us(wakes, WakeCause::steal), 3'500.0);
  EXPECT_FALSE(longest_us(wakes, WakeCause::process));
}

}  // namespace
}  // namespace kerf::bench::doctor

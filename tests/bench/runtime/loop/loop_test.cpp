#include "loop/loop.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scripted.h"

namespace kerf::bench {
namespace {

using drivers::Status;
using test::Bench;
using testing::Each;
using testing::ElementsAre;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(Loop, RunsEveryTickOnTheGrid) {
  Bench bench;
  const LoopReport report = bench.run(100);
  EXPECT_EQ(report.executed, 100U);
  EXPECT_EQ(report.missed(), 0U);
  EXPECT_EQ(report.end, LoopEnd::completed);
  EXPECT_EQ(bench.done, 100U);
  EXPECT_EQ(bench.recorder.rows.back().tick, 99U);
  EXPECT_DOUBLE_EQ(bench.recorder.rows.back().time_s, 0.099);
  EXPECT_THAT(bench.periods_s, Each(test::period_s));
}

TEST(Loop, TimesEachStageOfATick) {
  Bench bench;
  const double periods[] = {0.05, 0.1, 0.2, 0.15, 0.025};
  for (std::size_t stage = 0; stage < 5; ++stage) {
    bench.script.delay(static_cast<Stage>(stage), 3, periods[stage]);
  }
  const LoopReport report = bench.run(10);
  EXPECT_EQ(report.missed(), 0U);
  for (std::size_t stage = 0; stage < 5; ++stage) {
    EXPECT_EQ(report.stages[stage].max_ns(), 1e6 * periods[stage]) << stage_names[stage];
  }
  EXPECT_EQ(report.cycle.max_ns(), 1e6 * 0.475) << "the cycle is read to record";
  const schema::Row& row = bench.recorder.rows[3];
  EXPECT_FLOAT_EQ(row.wake_latency_s, 0.05e-3F);
  EXPECT_FLOAT_EQ(row.read_time_s, 0.1e-3F);
  EXPECT_FLOAT_EQ(row.compute_time_s, 0.2e-3F);
  EXPECT_FLOAT_EQ(row.write_time_s, 0.15e-3F);
}

TEST(Loop, KeepsADeadlineThatItReachesToTheNanosecond) {
  Bench bench;
  bench.script.delay(Stage::compute, 3, 1.0);
  EXPECT_EQ(bench.run(10).missed(), 0U);
}

TEST(Loop, GivesEveryStepAtLeastAPeriodHoweverLateAReadingEnds) {
  for (const double periods : {0.999999, 1.0, 1.000001, 2.0, 5.0}) {
    Bench bench;
    bench.script.delay(Stage::read, 3, periods);
    (void)bench.run(12);
    double sum_s = 0.0;
    for (const double step_s : bench.periods_s) {
      EXPECT_GE(step_s, test::period_s * (1.0 - 1e-12)) << periods;
      sum_s += step_s;
    }
    EXPECT_NEAR(sum_s, 12 * test::period_s, 1e-12) << "none is lost, and none counted twice";
  }
}

TEST(Loop, GivesTheLastStepTheTimeThatItsReadingTookAlsoBeyondTheRun) {
  Bench bench;
  bench.script.delay(Stage::read, 11, 5.0);
  (void)bench.run(12);
  EXPECT_NEAR(bench.periods_s.back(), 5.0 * test::period_s, 1e-12);
}

class LateStage : public testing::TestWithParam<Stage> {};

TEST_P(LateStage, IsChargedWithWhatItMadeTheLoopMiss) {
  Bench bench;
  bench.script.delay(GetParam(), 3, 2.3);
  const LoopReport report = bench.run(10);
  EXPECT_EQ(report.missed_by[static_cast<std::size_t>(GetParam())], 2U);
  EXPECT_EQ(report.missed(), 2U);
  EXPECT_EQ(report.executed, 8U);
  EXPECT_EQ(report.ticks(), 10U);
}
INSTANTIATE_TEST_SUITE_P(
    Each, LateStage, testing::Values(Stage::wake, Stage::read, Stage::compute, Stage::write, Stage::record),
    [](const auto& tested) { return stage_names[static_cast<std::size_t>(tested.param)]; });

TEST(Loop, SkipsWhatALateTickMissedAndStaysOnTheGrid) {
  Bench bench;
  bench.script.delay(Stage::compute, 3, 2.3);
  (void)bench.run(10);
  EXPECT_THAT(bench.ticks(), ElementsAre(0, 1, 2, 3, 6, 7, 8, 9));
  EXPECT_EQ(bench.recorder.rows[4].wake_latency_s, 0.0F) << "no tick inherits the lateness of the one before";
  EXPECT_DOUBLE_EQ(bench.periods_s[4], 3 * test::period_s);
}

TEST(Loop, SkipsWhatALateWakeUpMissedAndIsNeverRunInABurst) {
  Bench bench;
  bench.script.delay(Stage::wake, 3, 3.5);
  const LoopReport report = bench.run(10);
  EXPECT_THAT(bench.ticks(), ElementsAre(0, 1, 2, 6, 7, 8, 9)) << "it woke up in the period of tick 6";
  EXPECT_FLOAT_EQ(bench.recorder.rows[3].wake_latency_s, 3.5e-3F);
  EXPECT_EQ(bench.recorder.rows[4].wake_latency_s, 0.0F);
  EXPECT_EQ(report.missed_by[0], 3U);
  EXPECT_DOUBLE_EQ(bench.periods_s[3], 4 * test::period_s);
}

TEST(Loop, NeverBlamesTheMachineForALawThatIsTooSlow) {
  Bench bench;
  for (std::uint64_t tick = 0; tick < 100; ++tick) bench.script.delay(Stage::compute, tick, 1.2);
  const LoopReport report = bench.run(100);
  EXPECT_EQ(report.missed_by[static_cast<std::size_t>(Stage::compute)], 50U) << "every second one";
  EXPECT_EQ(report.missed(), 50U);
}

TEST(Loop, BlamesEachForItsPartWhereBothAreLate) {
  Bench bench;
  bench.script.delay(Stage::wake, 3, 2.1);
  bench.script.delay(Stage::compute, 5, 1.5);
  const LoopReport report = bench.run(10);
  EXPECT_EQ(report.missed_by[static_cast<std::size_t>(Stage::wake)], 2U);
  EXPECT_EQ(report.missed_by[static_cast<std::size_t>(Stage::compute)], 1U);
}

TEST(Loop, EndsWithItsGridHoweverLateTheLastTickIs) {
  Bench bench;
  bench.script.delay(Stage::wake, 7, 50.0);
  const LoopReport report = bench.run(10);
  EXPECT_THAT(bench.ticks(), ElementsAre(0, 1, 2, 3, 4, 5, 6, 9));
  EXPECT_EQ(report.ticks(), 10U);

  Bench slow;
  slow.script.delay(Stage::compute, 8, 50.0);
  EXPECT_EQ(slow.run(10).ticks(), 10U);
}

TEST(Loop, FlagsTheRowAfterAMiss) {
  Bench bench;
  bench.script.delay(Stage::read, 3, 1.1);
  bench.script.delay(Stage::wake, 7, 1.1);
  (void)bench.run(12);
  for (const schema::Row& row : bench.recorder.rows) {
    const bool late = row.tick == 5 || row.tick == 8;
    EXPECT_EQ((row.flags & schema::flag_missed_deadline) != 0, late) << "tick " << row.tick;
  }
}

TEST(Loop, GivesZeroForceBeforeTheFirstTickAndAtTheEnd) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  (void)bench.run(3);
  EXPECT_THAT(bench.device.written, ElementsAre(0.0, 1.0, 1.0, 1.0, 0.0));
}

TEST(Loop, GivesZeroForceAfterAStop) {
  Bench bench;
  bench.force = [&](std::uint64_t tick) {
    bench.stop = tick == 2;
    return 1.0;
  };
  const LoopReport report = bench.run(1000);
  EXPECT_EQ(report.end, LoopEnd::stopped);
  EXPECT_EQ(report.executed, 3U);
  EXPECT_EQ(bench.device.written.back(), 0.0);
}

TEST(Loop, GivesZeroForceWhileTheDeviceFaults) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  bench.device.answer = [](std::uint64_t tick, auto&) { return tick == 2 ? Status::fault : Status::ok; };
  const LoopReport report = bench.run(4);
  EXPECT_THAT(bench.device.written, ElementsAre(0.0, 1.0, 1.0, 0.0, 1.0, 0.0));
  EXPECT_EQ(report.ticks_with(schema::flag_device_fault), 1U);
  EXPECT_EQ(bench.recorder.rows[2].flags, schema::flag_device_fault);
  EXPECT_EQ(bench.recorder.rows[2].force_commanded[0], 0.0);
  EXPECT_EQ(report.end, LoopEnd::completed);
}

TEST(Loop, RecordsAFaultOfTheSensorAndGoesOnRendering) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  bench.device.answer = [](std::uint64_t tick, drivers::Sample& sample) {
    sample.sensor_fault = tick == 2;
    return Status::ok;
  };
  const LoopReport report = bench.run(4);
  EXPECT_THAT(bench.device.written, ElementsAre(0.0, 1.0, 1.0, 1.0, 1.0, 0.0));
  EXPECT_EQ(report.ticks_with(schema::flag_sensor_fault), 1U);
  EXPECT_EQ(bench.recorder.rows[2].flags, schema::flag_sensor_fault);
}

TEST(Loop, TakesANumberThatIsNotFiniteForAFaultOfTheDevice) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  bench.device.answer = [](std::uint64_t tick, drivers::Sample& sample) {
    sample.position[0] = tick == 2 ? not_a_number : 0.01 * static_cast<double>(tick);
    return Status::ok;
  };
  const LoopReport report = bench.run(4);
  EXPECT_THAT(bench.device.written, ElementsAre(0.0, 1.0, 1.0, 0.0, 1.0, 0.0));
  EXPECT_EQ(report.ticks_with(schema::flag_device_fault), 1U);
  EXPECT_TRUE(std::isfinite(report.energy_j));
}

TEST(Loop, GivesZeroForceAtOnceWhenTheLawGivesNoNumber) {
  Bench bench;
  bench.force = [](std::uint64_t tick) { return tick == 4 ? not_a_number : 7.0; };
  const LoopReport report = bench.run(7);
  EXPECT_EQ(bench.recorder.rows[3].force_commanded[0], 7.0);
  EXPECT_EQ(bench.recorder.rows[4].force_commanded[0], 0.0) << "not let down at the slew limit";
  EXPECT_TRUE(bench.recorder.rows[4].flags & schema::flag_law_fault);
  EXPECT_EQ(bench.recorder.rows[5].force_commanded[0], 2.0) << "and from there at the slew limit";
  EXPECT_EQ(report.ticks_with(schema::flag_law_fault), 1U);
}

TEST(Loop, EndsWithZeroForceWhenTheDeviceIsLost) {
  for (const bool by_read : {true, false}) {
    Bench bench;
    bench.force = [](auto) { return 1.0; };
    if (by_read) {
      bench.device.answer = [](std::uint64_t tick, auto&) { return tick == 2 ? Status::lost : Status::ok; };
    } else {
      bench.device.write_answers[2] = Status::lost;
    }
    const LoopReport report = bench.run(1000);
    EXPECT_EQ(report.end, LoopEnd::device_lost);
    EXPECT_EQ(report.executed, 3U);
    EXPECT_EQ(bench.device.written.back(), 0.0);
    EXPECT_EQ(bench.recorder.rows.back().force_commanded[0], 0.0);
  }
}

TEST(Loop, StartsSoftly) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  (void)bench.run(300, 0.25);
  const auto& rows = bench.recorder.rows;
  EXPECT_EQ(rows[0].force_commanded[0], 0.0);
  EXPECT_DOUBLE_EQ(rows[125].force_commanded[0], 0.5);
  EXPECT_TRUE(rows[249].flags & schema::flag_soft_start);
  EXPECT_EQ(rows[250].force_commanded[0], 1.0);
  EXPECT_FALSE(rows[250].flags & schema::flag_soft_start);
}

TEST(Loop, RecordsTheForceThatItWrote) {
  Bench bench;
  bench.force = [](std::uint64_t tick) { return tick < 5 ? 100.0 : -100.0; };
  const LoopReport report = bench.run(12);
  ASSERT_EQ(bench.device.written.size(), 14U);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(bench.recorder.rows[i].force_commanded[0], bench.device.written[i + 1]);
  }
  EXPECT_EQ(report.ticks_with(schema::flag_force_limited), 12U) << "every one of them asks for more than 7 N";
}

TEST(Loop, LetsTheForceInSoftlyAgainAfterAFault) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  bench.device.answer = [](std::uint64_t tick, auto&) { return tick == 400 ? Status::fault : Status::ok; };
  (void)bench.run(700, 0.25);
  const auto& rows = bench.recorder.rows;
  EXPECT_EQ(rows[399].force_commanded[0], 1.0);
  EXPECT_EQ(rows[400].force_commanded[0], 0.0);
  EXPECT_DOUBLE_EQ(rows[525].force_commanded[0], 0.5);
  EXPECT_EQ(rows[650].force_commanded[0], 1.0);
}

TEST(Loop, GivesZeroForceWhereThePositionIsFartherThanAHandCanMoveIt) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  bench.device.speed_limit(50.0);  // 0.05 rad in a tick
  bench.device.answer = [](std::uint64_t tick, drivers::Sample& sample) {
    sample.position[0] = (tick >= 3 ? 0.06 : 0.0) + (tick >= 5 ? 0.04 : 0.0);
    return Status::ok;
  };
  const LoopReport report = bench.run(7);
  EXPECT_THAT(bench.device.written, ElementsAre(0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(bench.recorder.rows[3].flags, schema::flag_position_jump);
  EXPECT_EQ(report.ticks_with(schema::flag_position_jump), 1U);
  EXPECT_EQ(report.ticks_with(schema::flag_zero_held), 3U);
  EXPECT_EQ(report.energy_j, 0.0) << "the jump is no work";
}

class SilentStage : public testing::TestWithParam<Stage> {};

TEST_P(SilentStage, GetsZeroForceForItsLateTickAndASoftStart) {
  Bench bench;
  bench.force = [](auto) { return 1.0; };
  bench.script.delay(GetParam(), 300, 10.5);  // the watchdog waits 10 ms
  const LoopReport report = bench.run(700, 0.25);
  EXPECT_EQ(report.ticks_with(schema::flag_watchdog), 1U);
  const auto late = std::ranges::find_if(
      bench.recorder.rows, [](const schema::Row& row) { return (row.flags & schema::flag_watchdog) != 0; });
  ASSERT_NE(late, bench.recorder.rows.end());
  EXPECT_EQ(late->force_commanded[0], 0.0);
  EXPECT_NEAR((late + 125)->force_commanded[0], 0.5, 1e-12) << "of the ticks that were executed";
  EXPECT_EQ((late + 250)->force_commanded[0], 1.0);
}
INSTANTIATE_TEST_SUITE_P(
    Each, SilentStage, testing::Values(Stage::wake, Stage::read, Stage::compute, Stage::write, Stage::record),
    [](const auto& tested) { return stage_names[static_cast<std::size_t>(tested.param)]; });

TEST(Loop, IsNotTakenForSilentBeforeTenMilliseconds) {
  Bench bench;
  bench.script.delay(Stage::compute, 3, 8.9);
  EXPECT_EQ(bench.run(30).ticks_with(schema::flag_watchdog), 0U);
}

TEST(Loop, HeedsAWatchdogThatActedForWhateverReason) {
  Bench bench;
  bench.force = [&](std::uint64_t tick) {
    // What the watchdog's own thread does, seen from a tick that thinks itself in time.
    if (tick == 2) (void)bench.heartbeat.release_if_silent(bench.device, 1'000'000'000, 10'000'000);
    return 1.0;
  };
  const LoopReport report = bench.run(5);
  EXPECT_THAT(bench.device.written, ElementsAre(0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0));
  EXPECT_EQ(report.ticks_with(schema::flag_watchdog), 1U);
  EXPECT_EQ(bench.device.released_at_s.size(), 1U);
}

TEST(Loop, MeasuresTheProcessorTimeOfEverySecondTickInStepWithNoTurn) {
  Bench bench;
  for (std::uint64_t tick = 0; tick < 64; tick += 2) bench.script.delay(Stage::compute, tick, 0.25);
  const LoopReport report = bench.run(64);
  EXPECT_EQ(report.compute_cpu.count(), 32U);
  EXPECT_EQ(report.compute_cpu.max_ns(), 0.25e6);
  EXPECT_EQ(report.compute_cpu.mean_ns(), 0.125e6)
      << "a law that works in every second tick is seen as it is";
}

TEST(Loop, MeasuresTheProcessorTimeOfTheFirstTickWhichFindsNothingInTheCaches) {
  Bench bench;
  bench.script.delay(Stage::compute, 0, 0.25);
  const LoopReport report = bench.run(1);
  EXPECT_EQ(report.compute_cpu.count(), 1U);
  EXPECT_EQ(report.compute_cpu.max_ns(), 0.25e6);
}

}  // namespace
}  // namespace kerf::bench

#include "loop/blame.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scripted.h"

namespace kerf::bench {
namespace {

using test::Bench;
using test::Why;
using testing::HasSubstr;

/// What happens in a loop, and who is to blame for every deadline that it cost.
struct Known {
  const char* name;
  Cause cause;
  void (*happens)(Bench&);
  std::size_t late_ticks = 20;
};

/// The same in every hundredth tick.
template <Stage stage, Why why>
void every_hundredth(Bench& bench) {
  for (std::uint64_t tick = 50; tick < 2000; tick += 100) bench.script.delay(stage, tick, 2.3, why);
}

const Known known[]{
    {"LawTooSlow", Cause::law,
     [](Bench& bench) {
       for (std::uint64_t tick = 0; tick < 2000; ++tick) bench.script.delay(Stage::compute, tick, 1.2);
     },
     1000},
    {"LawSlowOnceInTwoThousandTicks", Cause::law,
     [](Bench& bench) { bench.script.delay(Stage::compute, 1500, 30.0); }, 1},
    {"LawThatWaitsOfItself", Cause::law, every_hundredth<Stage::compute, Why::waits>},
    {"LawSlowInProportionToTheTimeThatALateMachineMadeItStepOver", Cause::machine,
     [](Bench& bench) {
       for (std::uint64_t tick = 50; tick < 2000; tick += 100)
         bench.script.delay(Stage::wake, tick, 4.5, Why::nothing);
       bench.compute_periods = 0.3;  // a period; 1.5 for the 5 that follow a wake-up 4 periods late
     },
     40},
    {"PreemptedInRead", Cause::machine, every_hundredth<Stage::read, Why::is_preempted>},
    {"PreemptedInCompute", Cause::machine, every_hundredth<Stage::compute, Why::is_preempted>},
    {"PreemptedInWrite", Cause::machine, every_hundredth<Stage::write, Why::is_preempted>},
    {"PreemptedInRecord", Cause::machine, every_hundredth<Stage::record, Why::is_preempted>},
    {"HostAsleepBeforeTheTick", Cause::machine, every_hundredth<Stage::wake, Why::nothing>},
    {"HostAsleepInRead", Cause::machine, every_hundredth<Stage::read, Why::nothing>},
    {"HostAsleepInCompute", Cause::machine, every_hundredth<Stage::compute, Why::nothing>},
    {"PageReadFromADiskInCompute", Cause::machine, every_hundredth<Stage::compute, Why::reads_a_disk>},
    {"PageReadFromADiskInRead", Cause::machine, every_hundredth<Stage::read, Why::reads_a_disk>},
    {"DeviceThatAnswersLate", Cause::device, every_hundredth<Stage::read, Why::waits>},
    {"DeviceThatTakesOrdersLate", Cause::device, every_hundredth<Stage::write, Why::waits>},
    {"DriverThatComputes", Cause::device, every_hundredth<Stage::read, Why::works>},
};

class KnownCause : public testing::TestWithParam<Known> {};

TEST_P(KnownCause, IsNamedForEveryMiss) {
  Bench bench;
  GetParam().happens(bench);
  const LoopReport report = bench.run(2000);
  ASSERT_GT(report.missed(), 0U);
  EXPECT_EQ(report.late_ticks, GetParam().late_ticks);
  EXPECT_EQ(report.missed_because[static_cast<std::size_t>(GetParam().cause)], report.missed());
  for (const Miss& miss : report.first_misses()) {
    EXPECT_EQ(miss.cause, GetParam().cause) << in_words(miss);
    EXPECT_THAT(in_words(miss), testing::EndsWith(cause_names[static_cast<std::size_t>(GetParam().cause)]));
  }
}
INSTANTIATE_TEST_SUITE_P(Of, KnownCause, testing::ValuesIn(known),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(Blame, KnowsTheProcessorTimeOfALongStageToWithinWhatCameBeforeItAwake) {
  Bench bench;
  bench.script.delay(Stage::read, 3, 0.2);
  bench.script.delay(Stage::compute, 3, 1.5);
  const LoopReport report = bench.run(10);
  ASSERT_EQ(report.late_ticks, 1U);
  const Miss& miss = report.misses[0];
  EXPECT_EQ(miss.wall_ns, 1'500'000);
  EXPECT_EQ(miss.most_cpu_ns, 1'500'000);
  EXPECT_EQ(miss.least_cpu_ns, 1'500'000) << "the read of 0.2 ms is known to be before it";
  EXPECT_EQ(miss.periods, 1U);
  EXPECT_EQ(miss.waited, 0);
}

TEST(Blame, NamesNobodyWhereTheEvidenceDoesNotDecide) {
  EXPECT_EQ(
      cause_of(
          {.stage = Stage::compute, .wall_ns = 2'000'000, .most_cpu_ns = 700'000, .least_cpu_ns = 300'000},
          1e6),
      Cause::unknown)
      << "between 0.3 and 0.7 ms of 0.5 allowed";
  EXPECT_EQ(cause_of({.stage = Stage::read, .wall_ns = 2'000'000, .waited = 1, .preempted = 1}, 1e6),
            Cause::unknown)
      << "it waited, and was made to wait";
}

TEST(Blame, TakesAProcessThatStoodStillForTheMachines) {
  for (const Stage stage : {Stage::read, Stage::compute, Stage::write}) {
    const Miss stopped{.stage = stage, .wall_ns = 5'000'000'000, .waited = 1, .stood_still = true};
    EXPECT_EQ(cause_of(stopped, 1e6), Cause::machine);
    EXPECT_THAT(in_words(stopped), HasSubstr("the whole process stood still"));
  }
}

}  // namespace
}  // namespace kerf::bench

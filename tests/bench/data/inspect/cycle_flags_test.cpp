#include "inspect/cycle_flags.h"

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/data/inspect/closings.h"
#include "import/import.h"
#include "inspect/flagged_cycles.h"
#include "inspect/inspection.h"
#include "segment/segment.h"
#include "support/measured_data.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using test::Closings;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<FlaggedCycle> cycles_of(const schema::Recording& recording) {
  return inspect(schema::RowsInMemory(recording), {}).cycles.cycles;
}

/// The kinds of a cycle's flags.
std::set<std::string> flags_of(const FlaggedCycle& cycle) {
  std::set<std::string> kinds;
  for (const CycleFlag& flag : cycle.flags) kinds.emplace(name_of(flag.fault));
  return kinds;
}

TEST(CycleFlags, AreNoneOfCyclesThatAreAlike) {
  const auto cycles = cycles_of(Closings{}.made());
  ASSERT_EQ(cycles.size(), 10U);
  for (const FlaggedCycle& cycle : cycles) {
    EXPECT_THAT(flags_of(cycle), IsEmpty()) << cycle.facts.number;
    // The end tenths of a cosine's way, by which turning round counts, take 0.144 of its time at either end.
    EXPECT_NEAR(cycle.facts.closing_s, 0.5 * (1.0 - 2.0 * std::acos(0.9) / std::numbers::pi), 0.01);
    EXPECT_NEAR(cycle.facts.peak, 5.0, 0.06) << "spring and friction together";
    EXPECT_NEAR(cycle.facts.work, 0.5 * 1.0, 0.03) << "the friction's, 1 N over 0.5 rad";
    EXPECT_NEAR(cycle.facts.closing_work, 0.5 * (2.0 + 1.0), 0.08) << "the spring's too";
    ASSERT_TRUE(cycle.farthest);
  }
  EXPECT_EQ(good_cycles(cycles), "1-10");
}

TEST(CycleFlags, NameAToolThatWasPutDown) {
  Closings closings;
  closings.put_down = true;
  closings.last_hold_s = 12.0;
  const auto cycles = cycles_of(closings.made());
  ASSERT_EQ(cycles.size(), 10U);
  EXPECT_THAT(flags_of(cycles[9]), ElementsAre("interrupted", "put_down"));
  EXPECT_GT(cycles[9].facts.idle_hold_s, 11.0);
  EXPECT_EQ(good_cycles(cycles), "1-9");
}

TEST(CycleFlags, LetAToolHoldWhatItFeels) {
  Closings closings;
  closings.last_hold_s = 12.0;  // with its force
  EXPECT_EQ(good_cycles(cycles_of(closings.made())), "1-10");
}

TEST(CycleFlags, NameCyclesThatMeetNothingOrLittle) {
  Closings closings;
  closings.peaks[3] = 0.01;
  closings.peaks[6] = 1.0;
  const auto cycles = cycles_of(closings.made());
  EXPECT_THAT(flags_of(cycles[3]), ElementsAre("under_force"));
  EXPECT_THAT(cycles[3].flags[0].reason, HasSubstr("is not felt"));
  EXPECT_THAT(flags_of(cycles[6]), ElementsAre("under_force"));
  EXPECT_THAT(cycles[6].flags[0].reason, HasSubstr("less than a third of the usual"));
  EXPECT_EQ(good_cycles(cycles), "1-3,5-6,8-10");
}

TEST(CycleFlags, NameCyclesInWhichTheSensorIsClipped) {
  Closings closings;
  closings.peaks[4] = 12.0;
  schema::Recording recording = closings.made();
  for (double& force : recording.force_measured) force = std::min(force, 8.0);
  const auto cycles = cycles_of(recording);
  EXPECT_THAT(flags_of(cycles[4]), ElementsAre("clipped"));
  EXPECT_GT(cycles[4].facts.clipped_rows, 300U);
  EXPECT_EQ(cycles[5].facts.clipped_rows, 0U);
}

TEST(CycleFlags, NameAnOutlierByItsDistance) {
  Closings closings;
  closings.peaks = {4.0, 4.1, 3.9, 4.2, 3.8, 7.5, 4.0, 4.1, 3.9, 4.0};
  const auto cycles = cycles_of(closings.made());
  EXPECT_THAT(flags_of(cycles[5]), ElementsAre("outlier"));
  EXPECT_GT(cycles[5].farthest->distance, 5.6);
  EXPECT_EQ(good_cycles(cycles), "1-5,7-10");
}

TEST(CycleFlags, KnowNoDistanceAmongFewCycles) {
  Closings closings;
  closings.peaks = {4.0, 4.0, 4.0, 7.5};
  const auto cycles = cycles_of(closings.made());
  ASSERT_EQ(cycles.size(), 4U);
  EXPECT_EQ(cycles[3].farthest, std::nullopt);
  EXPECT_TRUE(cycles[3].is_good());
}

TEST(CycleFlags, NameACycleWithAGap) {
  schema::Recording recording = Closings{}.made();
  for (std::size_t row = 6'000; row < recording.time.size(); ++row) recording.time[row] += 0.3;
  const auto cycles = cycles_of(recording);
  EXPECT_THAT(flags_of(cycles[3]), testing::Contains("interrupted"));
  EXPECT_TRUE(cycles[2].is_good());
}

TEST(CycleFlags, SayWhyThereIsNoCycle) {
  schema::Recording recording = Closings{}.made();
  for (double& position : recording.position) position = 0.1;
  const Inspection inspection = inspect(schema::RowsInMemory(recording), {});
  EXPECT_THAT(inspection.cycles.cycles, IsEmpty());
  EXPECT_THAT(inspection.cycles.why_none, HasSubstr("no cycle of opening and closing"));
}

TEST(CycleFlags, TakeTheCyclesThatAreStored) {
  schema::Recording recording = Closings{}.made();
  recording.cycles = find_cycles(recording, {});
  std::erase_if(recording.cycles->phases, [](const schema::PhaseSpan& phase) { return phase.cycle != 7; });
  const Inspection inspection = inspect(schema::RowsInMemory(recording), {});
  EXPECT_TRUE(inspection.cycles.are_stored);
  ASSERT_EQ(inspection.cycles.cycles.size(), 1U);
  EXPECT_EQ(inspection.cycles.cycles[0].facts.number, 7U);
  recording.cycles->phases[0].end = 1'000'000;
  EXPECT_THROW((void)inspect(schema::RowsInMemory(recording), {}), schema::FormatError);
}

TEST(CycleFlags, ChooseTheRowsOfAPreparedRecording) {
  Closings closings;
  closings.put_down = true;
  closings.last_hold_s = 12.0;
  closings.peaks[3] = 0.01;
  schema::Recording recording = closings.made();
  recording.header = schema::new_header("kerf test");
  const test::TemporaryFolder folder;
  const std::string file = (folder / "r.h5").string();
  const std::string output = (folder / "out.h5").string();
  schema::write_recording(file, recording);
  const std::vector<std::string> prepare{"prepare", file, "--cycles", "good", "-o", output, "--json"};
  const auto refused = test::run_kerf(prepare);
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("it has no cycles; run 'kerf segment' first"));
  recording.cycles = find_cycles(recording, {});
  schema::write_recording(file, recording);
  const auto outcome = test::run_kerf(prepare);
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto left_out = nlohmann::json::parse(outcome.output).at("cycles_left_out");
  ASSERT_EQ(left_out.size(), 2U);
  EXPECT_EQ(left_out[0]["number"], 4);
  EXPECT_EQ(left_out[1]["number"], 10);
  EXPECT_THAT(left_out[1]["reason"].get<std::string>(), HasSubstr("the tool was put down"));
  const schema::Recording kept = schema::read_recording(output);
  EXPECT_EQ(kept.cycles->closing.size(), 8U);
  EXPECT_LT(kept.rows(), 8U * 1'800U) << "the twelve seconds are gone";
}

// Findings L2 and L3, cycle by cycle; seen by eye in plots of position and force.
TEST(CycleFlags, OfPunchesFindTheToolThatWasPutDown) {
  struct Known {
    std::size_t cycles;
    std::set<std::uint32_t> put_down, clipped, not_felt;
  };
  const std::map<std::string, Known> known{
      {"7_blank_slow_1819", {.cycles = 11, .put_down = {11}, .clipped = {}, .not_felt = {8, 11}}},
      {"11_meniscus_fast_1826", {.cycles = 12, .put_down = {12}, .clipped = {}, .not_felt = {12}}},
      {"14_quadriceps_tendon_fast_1853",
       {.cycles = 12, .put_down = {1, 12}, .clipped = {11, 12}, .not_felt = {}}},
      {"15_skin_knee_lateral_slow_1900", {.cycles = 12, .put_down = {12}, .clipped = {}, .not_felt = {5}}},
      {"16_skin_knee_lateral_fast_1904", {.cycles = 17, .put_down = {17}, .clipped = {}, .not_felt = {}}}};
  for (const auto& [name, expected] : known) {
    KERF_NEEDS_DATA("meniscus/" + name + ".txt");
    const auto cycles = cycles_of(import_text(test::measured_file("meniscus/" + name + ".txt"),
                                              {.map = parse_map("time=5[ms],position=4[deg],force=2[gf]")})
                                      .recording);
    ASSERT_EQ(cycles.size(), expected.cycles) << name;
    for (const FlaggedCycle& cycle : cycles) {
      const auto kinds = flags_of(cycle);
      const std::uint32_t number = cycle.facts.number;
      EXPECT_EQ(kinds.contains("put_down"), expected.put_down.contains(number)) << name << " " << number;
      EXPECT_EQ(kinds.contains("clipped"), expected.clipped.contains(number)) << name << " " << number;
      EXPECT_TRUE(kinds.contains("under_force") || !expected.not_felt.contains(number))
          << name << " " << number;
    }
  }
}

schema::Recording of_three_cycles() {
  schema::Recording recording;
  schema::Cycles& cycles = recording.cycles.emplace();
  cycles.grid = {0.0, 1.0};
  cycles.closing = {{1.0, 2.0}, {3.0, 4.0}, {20.0, 30.0}};
  cycles.opening = {{0.0, 1.0}, {2.0, 3.0}, {10.0, 10.0}};
  cycles.closing_mean = {8.0, 12.0};
  cycles.opening_mean = {4.0, 14.0 / 3.0};
  for (std::uint32_t cycle = 1; cycle <= 3; ++cycle)
    cycles.phases.push_back(
        {.cycle = cycle, .phase = schema::Phase::closing, .begin = cycle, .end = cycle + 1});
  return recording;
}

TEST(CycleMeans, AreOfTheCyclesThatAreNotLeftOut) {
  schema::Recording recording = of_three_cycles();
  EXPECT_EQ(means_of_good_cycles(recording, *recording.cycles).closing, recording.cycles->closing_mean)
      << "nobody said of one that it is not good";
  recording.cycle_flags.emplace();
  recording.cycle_flags->flags.push_back({.cycle = 3, .fault = "by_hand", .reason = "it slipped"});
  const CycleMeans means = means_of_good_cycles(recording, *recording.cycles);
  EXPECT_EQ(means.cycles, 2U);
  EXPECT_EQ(means.closing, (std::vector{2.0, 3.0}));
  EXPECT_EQ(means.opening, (std::vector{1.0, 2.0}));
  recording.cycle_flags->flags.push_back({.cycle = 3, .fault = "accepted", .reason = "it did not"});
  EXPECT_EQ(means_of_good_cycles(recording, *recording.cycles).cycles, 3U);
  for (std::uint32_t cycle = 1; cycle <= 2; ++cycle)
    recording.cycle_flags->flags.push_back({.cycle = cycle, .fault = "by_hand", .reason = "another tool"});
  recording.cycle_flags->flags[1].cycle = 1;  // which is accepted, and so the only one
  EXPECT_EQ(means_of_good_cycles(recording, *recording.cycles).closing, (std::vector{1.0, 2.0}));
}

TEST(CycleMeans, AreOfAllCyclesWhereNoneIsGood) {
  const schema::Recording recording = of_three_cycles();
  EXPECT_EQ(means_of_good_cycles(*recording.cycles, {false, false, false}).cycles, 3U);
}

}  // namespace
}  // namespace kerf::bench

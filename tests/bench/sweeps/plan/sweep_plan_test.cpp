#include "plan/sweep_plan.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

using Sweep = test::SweepFolder;

TEST_F(Sweep, IsTheProductOfItsInputsTheLastOneFastest) {
  const SweepPlan plan = plan_of(test::walls()).plan;
  ASSERT_EQ(plan.cells(), 20U);
  EXPECT_EQ(plan.cell(0).number("mass"), 0.05);
  EXPECT_EQ(plan.cell(0).number("stiffness"), 100.0);
  EXPECT_EQ(plan.cell(3).number("stiffness"), 1000.0) << "a third of the decades further up";
  EXPECT_EQ(plan.cell(9).number("mass"), 0.05);
  EXPECT_EQ(plan.cell(10).number("mass"), 0.1);
  EXPECT_EQ(plan.cell(19).number("stiffness"), 100000.0);
  EXPECT_EQ(plan.cell(19).number("push"), 2.0) << "the standard of what is not given";
  EXPECT_THROW((void)plan.cell(20), std::out_of_range);
}

TEST_F(Sweep, IsAListWhereThereAreSeveralProducts) {
  const SweepPlan plan = plan_of(
                             "version = 1\nverb = \"stability\"\n"
                             "[[cells]]\nmass = 0.05\nstiffness = 100\n"
                             "[[cells]]\nmass = 0.2\nstiffness = [300, 400]\ngrip = \"light\"\n")
                             .plan;
  ASSERT_EQ(plan.cells(), 3U);
  EXPECT_EQ(plan.cell(0).text("grip"), "none");
  EXPECT_EQ(plan.cell(2).text("grip"), "light");
  EXPECT_EQ(plan.cell(2).number("stiffness"), 400.0);
}

TEST_F(Sweep, OfAHundredMillionCellsIsNoLargerThanOfTen) {
  schema::write_recording(file("r.h5"), test::punch({.seconds = 0.1}));
  const SweepPlan plan = plan_of(
                             "version = 1\nverb = \"fit\"\n[cells]\nrecording = \"r.h5\"\nlaw = \"kelvin\"\n"
                             "noise = 0.01\nseed = { from = 1, to = 100000000 }\n")
                             .plan;
  ASSERT_EQ(plan.cells(), 100'000'000U);
  EXPECT_EQ(plan.cell(99'999'999).number("seed"), 1e8);
  EXPECT_LT(plan.as_json().dump().size(), 1000U);
}

TEST_F(Sweep, NamesACellByWhatItIsForEver) {
  const SweepPlan plan = plan_of(test::walls()).plan;
  EXPECT_EQ(plan.name_of(plan.cell(0)), "9e2b35b0bf42f95df23a99fe1eabdc7e");
  const SweepPlan other =
      plan_of(
          "version = 1\nverb = \"stability\"\n[cells]\nmass = [1, 0.05]\nstiffness = [7, 100]\n"
          "seconds = 0.05\npush = 2\n")
          .plan;
  EXPECT_EQ(other.name_of(other.cell(3)), plan.name_of(plan.cell(0)))
      << "in another sweep, and with a standard that is given";
  std::set<std::string> names;
  for (std::uint64_t i = 0; i < plan.cells(); ++i) names.insert(plan.name_of(plan.cell(i)));
  EXPECT_EQ(names.size(), plan.cells());
}

TEST_F(Sweep, NamesRecordingsByTheirContent) {
  const PlanFile plan = fits(2);
  std::filesystem::rename(file("r.h5"), file("moved.h5"));
  test::replace_in(file("w.toml"), "r.h5", "moved.h5");
  const SweepPlan moved = read_sweep(file("w.toml"));
  EXPECT_EQ(moved.name_of(moved.cell(1)), plan.plan.name_of(plan.plan.cell(1)));
  schema::write_recording(file("moved.h5"), test::punch({.seconds = 2.0, .seed = 9}));
  const SweepPlan changed = read_sweep(file("w.toml"));
  EXPECT_NE(changed.name_of(changed.cell(1)), plan.plan.name_of(plan.plan.cell(1)));
}

TEST(ShardRange, GivesEveryCellToOneShard) {
  for (const std::uint64_t shards : {1U, 3U, 7U, 20U, 33U}) {
    std::uint64_t next = 0;
    for (std::uint64_t shard = 0; shard < shards; ++shard) {
      const ShardRange range = shard_range(20, shard, shards);
      EXPECT_EQ(range.begin, next);
      EXPECT_LE(range.size(), 20 / shards + 1);
      next = range.end;
    }
    EXPECT_EQ(next, 20U);
  }
  EXPECT_EQ(shard_range(1'000'000'000'000, 999'999, 1'000'000).end, 1'000'000'000'000U);
}

TEST_F(Sweep, PlanThatWasChangedIsNoPlan) {
  (void)plan_of(test::walls());
  test::replace_in(file("w.plan.json"), "0.05", "0.06");
  try {
    (void)read_plan(file("w.plan.json"));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("it was changed after it was written"), std::string::npos);
  }
}

TEST_F(Sweep, PlanStandsWhereItIsWrittenAndFindsItsRecordings) {
  const PlanFile here = fits(2);
  std::filesystem::create_directory(file("elsewhere"));
  write_plan(file("elsewhere/w.plan.json"), here.plan, std::nullopt, false);
  const PlanFile there = read_plan(file("elsewhere/w.plan.json"));
  EXPECT_EQ(there.plan.cell(0).text("recording"), "../r.h5");
  EXPECT_EQ(there.plan.name_of(there.plan.cell(0)), here.plan.name_of(here.plan.cell(0)));
  EXPECT_NO_THROW(require_planned_files(there.plan, {.begin = 0, .end = 4}));
  std::filesystem::remove(file("r.h5"));
  EXPECT_THROW(require_planned_files(there.plan, {.begin = 0, .end = 4}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

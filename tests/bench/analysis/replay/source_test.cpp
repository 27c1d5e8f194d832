#include "replay/source.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

std::string refusal_of(const schema::Recording& recording, const SelectOptions& options = {}) {
  try {
    (void)select_rows(recording, options, "cut.h5");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ReplayRows, KnowThePeriodOfTheLoopToTheLastBit) {
  for (const double rate_hz : {1000.0, 333.0, 2500.0}) {
    schema::Recording recording = test::sine_of_scissors(1000);
    for (std::size_t row = 0; row < recording.rows(); ++row)
      recording.time[row] = static_cast<double>(row) * (1.0 / rate_hz);
    const Source source = select_rows(recording, {}, "cut.h5");
    EXPECT_TRUE(source.on_grid);
    EXPECT_EQ(source.period_s, 1.0 / rate_hz);
  }
}

TEST(ReplayRows, WithTimesOfTheirOwnAreOnNoGrid) {
  schema::Recording recording = test::sine_of_scissors(1000);
  recording.time[500] += 1e-5;
  const Source source = select_rows(recording, {}, "cut.h5");
  EXPECT_FALSE(source.on_grid);
  EXPECT_NEAR(source.period_s, 1e-3, 1e-9);
}

TEST(ReplayRows, AreChosenByTimeAndKeepTheirNumbers) {
  const Source source =
      select_rows(test::sine_of_scissors(), {.from_s = 0.5, .to_s = 1.0, .cycles = {}}, "cut.h5");
  EXPECT_EQ(source.recording.rows(), 501U);
  EXPECT_EQ(source.row.front(), 500U);
  EXPECT_FALSE(source.from_start);
}

TEST(ReplayRows, AreChosenByCycleWithAGapBetweenThem) {
  schema::Recording recording = test::sine_of_scissors();
  schema::Cycles cycles;
  for (std::uint32_t cycle = 1; cycle <= 4; ++cycle)
    cycles.phases.push_back(
        {.cycle = cycle, .phase = schema::Phase::closing, .begin = 400 * (cycle - 1), .end = 400 * cycle});
  recording.cycles = cycles;
  const Source source = select_rows(recording, {.from_s = {}, .to_s = {}, .cycles = {2, 4}}, "cut.h5");
  EXPECT_EQ(source.recording.rows(), 800U);
  EXPECT_EQ(source.recording.time.front(), 0.4);
  ASSERT_EQ(source.gaps.size(), 1U);
  EXPECT_EQ(source.gaps[0].after, 399U);
  EXPECT_EQ(source.gaps[0].end_s, 1.2);
  EXPECT_THAT(refusal_of(recording, {.from_s = {}, .to_s = {}, .cycles = {7}}), HasSubstr("no cycle 7"));
}

TEST(ReplayRows, ThatAreNotFiniteAreRefusedWithRowAndTime) {
  schema::Recording recording = test::sine_of_scissors();
  recording.position[700] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_of(recording), HasSubstr("row 700 at 0.7 s: the position of 'theta' is nan"));
  EXPECT_EQ(refusal_of(recording, {.from_s = 0.8, .to_s = {}, .cycles = {}}), "");
  recording.position[700] = 0.0;
  recording.velocity[700] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal_of(recording), HasSubstr("row 700 at 0.7 s: the velocity of 'theta' is inf"));
}

TEST(ReplayRows, WhoseTimeGoesBackAreRefused) {
  schema::Recording recording = test::sine_of_scissors();
  recording.time[9] = recording.time[8];
  EXPECT_THAT(refusal_of(recording), HasSubstr("row 9"));
  EXPECT_THAT(refusal_of(test::sine_of_scissors(), {.from_s = 7.0, .to_s = {}, .cycles = {}}),
              HasSubstr("from 0 to 2 s"));
}

TEST(ReplayGaps, AreBridgedByStraightLinesWithoutAForce) {
  const schema::Recording whole = test::sine_of_scissors();
  const Source source = select_rows(test::without_rows(whole, 100, 110), {}, "cut.h5");
  ASSERT_EQ(source.gaps.size(), 1U);
  EXPECT_THAT(gaps_in_words(source, false), HasSubstr("1 gap in the recording, the longest of 11 ms"));
  const schema::Recording filled = bridged(source).recording;
  EXPECT_EQ(filled.tick, whole.tick);
  EXPECT_EQ(filled.time, whole.time);
  EXPECT_NEAR(filled.position[104],
              whole.position[99] + 5.0 / 11.0 * (whole.position[110] - whole.position[99]), 1e-15);
  EXPECT_TRUE(std::isnan(filled.force_measured[104]));
  EXPECT_EQ(filled.flags[104], schema::flag_resampled);
  EXPECT_EQ(filled.force_measured[110], 1.0);
}

TEST(ReplaySpeed, TakesEveryOtherRowAtTwiceTheSpeed) {
  const schema::Recording whole = test::sine_of_scissors();
  const schema::Recording fast = at_speed(select_rows(whole, {}, "cut.h5"), 2.0).recording;
  ASSERT_EQ(fast.rows(), 1001U);
  for (std::size_t row = 0; row < fast.rows(); ++row) {
    EXPECT_EQ(fast.tick[row], row);
    EXPECT_NEAR(fast.position[row], whole.position[2 * row], 1e-12);
    EXPECT_NEAR(fast.velocity[row], 2.0 * whole.velocity[2 * row], 1e-10);
  }
}

TEST(ReplaySpeed, KeepsAGapAsOneAtTheTimesThatItThenHas) {
  const Source source = select_rows(test::without_rows(test::sine_of_scissors(), 100, 200), {}, "cut.h5");
  const Source slow = at_speed(source, 0.5);
  ASSERT_EQ(slow.gaps.size(), 1U);
  EXPECT_NEAR(slow.gaps[0].begin_s, 0.198, 1e-9);
  EXPECT_NEAR(slow.gaps[0].end_s, 0.4, 1e-9);
}

}  // namespace
}  // namespace kerf::bench

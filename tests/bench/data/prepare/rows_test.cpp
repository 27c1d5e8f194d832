#include "prepare/rows.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Three cycles of ten rows, closing and opening, after five rows that belong to none.
schema::Recording three_cycles() {
  schema::Recording recording;
  recording.axes = {{}};
  for (std::uint64_t i = 0; i < 35; ++i) {
    recording.time.push_back(0.1 * static_cast<double>(i));
    recording.tick.push_back(i);
    recording.position.push_back(static_cast<double>(i));
    recording.velocity.push_back(0.0);
    recording.force_measured.push_back(1.0);
    recording.flags.push_back(0);
  }
  recording.channels = {{.name = "t", .unit = "K", .values = recording.position}};
  recording.events = {{.time_s = 0.61, .kind = "first", .text = ""},
                      {.time_s = 1.6, .kind = "second", .text = ""}};
  schema::Cycles cycles;
  cycles.grid = {0.0, 1.0};
  for (std::uint32_t c = 0; c < 3; ++c) {
    const std::uint64_t begin = 5 + 10 * c;
    cycles.phases.push_back(
        {.cycle = c + 1, .phase = schema::Phase::closing, .begin = begin, .end = begin + 5});
    cycles.phases.push_back(
        {.cycle = c + 1, .phase = schema::Phase::opening, .begin = begin + 5, .end = begin + 10});
    cycles.closing.push_back({1.0 * c, 2.0 * c});
    cycles.opening.push_back({-1.0 * c, std::nan("")});
  }
  recording.cycles = cycles;
  return recording;
}

TEST(Rows, OfChosenCyclesAreExactlyTheirs) {
  schema::Recording recording = three_cycles();
  recording.cycle_flags = {.flags = {{.cycle = 2, .fault = "outlier", .reason = "far"},
                                     {.cycle = 3, .fault = "by_hand", .reason = "light"}}};
  keep_cycles(recording, {1, 3});
  ASSERT_EQ(recording.cycle_flags->flags.size(), 1U) << "that of the cycle that is gone, too";
  EXPECT_EQ(recording.cycle_flags->flags[0].cycle, 2U) << "numbered as the cycle is";
  EXPECT_EQ(recording.cycle_flags->flags[0].reason, "light");
  ASSERT_EQ(recording.rows(), 20U);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const std::uint64_t was = i < 10 ? 5 + i : 15 + i;
    EXPECT_EQ(recording.tick[i], was) << "the gap stays visible";
    EXPECT_EQ(recording.position[i], static_cast<double>(was));
    EXPECT_EQ(recording.channels[0].values[i], static_cast<double>(was));
    EXPECT_EQ(recording.time[i], 0.1 * static_cast<double>(was));
  }
  const auto& phases = recording.cycles->phases;
  ASSERT_EQ(phases.size(), 4U);
  EXPECT_EQ(phases[2].cycle, 2U);
  EXPECT_EQ(phases[2].begin, 10U);
  EXPECT_EQ(phases[3].end, 20U);
  EXPECT_THAT(recording.cycles->closing_mean, ElementsAre(1.0, 2.0));
  EXPECT_TRUE(std::isnan(recording.cycles->opening_mean[1]));
  ASSERT_EQ(recording.events.size(), 1U);
  EXPECT_EQ(recording.events[0].kind, "first");
}

TEST(Rows, ThatAreNotFiniteGoAndPhasesShrink) {
  schema::Recording recording = three_cycles();
  recording.force_measured[6] = std::numeric_limits<double>::quiet_NaN();
  recording.position[15] = std::numeric_limits<double>::infinity();
  keep_rows(recording, finite_rows(recording));
  EXPECT_EQ(recording.rows(), 33U);
  EXPECT_EQ(recording.flags.size(), 33U);
  EXPECT_EQ(recording.cycles->phases[0].end, 9U);
  EXPECT_EQ(recording.cycles->phases.back().end, 33U);
}

TEST(Rows, OfAnAxisThatNobodyMeasuredAreNoGaps) {
  schema::Recording recording = three_cycles();
  recording.force_measured.assign(35, std::numeric_limits<double>::quiet_NaN());
  const auto finite = finite_rows(recording);
  EXPECT_EQ(std::count(finite.begin(), finite.end(), false), 0);
}

TEST(Rows, OfCyclesThatAreNotThereAreRefused) {
  schema::Recording recording = three_cycles();
  EXPECT_THAT([&] { keep_cycles(recording, {4}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("there is no cycle 4; the recording has 3")));
  recording.cycles.reset();
  EXPECT_THAT([&] { keep_cycles(recording, {1}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("kerf segment")));
}

TEST(Rows, AreNamedByLists) {
  EXPECT_THAT(parse_cycles("2-4,10,3"), ElementsAre(2, 3, 4, 10));
  for (const char* text : {"", "0", "3-2", "a", "1-", "-1", "1,,2"}) {
    EXPECT_THROW((void)parse_cycles(text), std::invalid_argument) << text;
  }
  const auto spans = parse_spans("0:1.5,30:32");
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[1].begin_s, 30.0);
  for (const char* text : {"", "1", "2:1", "a:b", "1:2,"}) {
    EXPECT_THROW((void)parse_spans(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace kerf::bench

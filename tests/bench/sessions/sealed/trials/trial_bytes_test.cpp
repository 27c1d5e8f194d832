#include "sealed/trials/trial_bytes.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

RecordedTrial trial_of(std::size_t ticks) {
  RecordedTrial trial;
  trial.what = {.tissue = 1, .pair = {0, 2}, .slots = {1, 0, 1}, .level = 0.1 + 0.2, .practice = true};
  trial.answer = 1;
  trial.response_s = 12.125;
  trial.answerable_s = 8.0;
  trial.switches = 9;
  trial.at = "2026-01-31T12:00:00Z";
  trial.axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N·m", .lever = 0.0369},
                {.name = "x_s", .contact_position = 0.25, .contact_direction = -1.0}};
  trial.channels = {{.name = "temperature", .unit = "K", .values = {}}};
  for (std::size_t i = 0; i < ticks; ++i) {
    const auto x = static_cast<double>(i);
    TraceRow tick{.row = {.tick = i + 7, .time_s = 0.001 * x, .flags = schema::flag_soft_switch},
                  .slot = static_cast<std::uint8_t>(i % 2)};
    tick.row.position = {std::sin(x), x / 3.0};
    tick.row.velocity = {-x, -0.0};
    tick.row.force_commanded = {x * 0.1, 2.0};
    tick.row.force_measured = {std::nan(""), 3.0};
    tick.row.channels = {300.0 + x};
    tick.row.wake_latency_s = 1e-6F;
    tick.row.read_time_s = 2e-6F;
    tick.row.compute_time_s = 3e-6F;
    tick.row.write_time_s = 4e-6F;
    trial.trace.push_back(tick);
  }
  return trial;
}

TEST(TrialBytes, ComeBackBitForBit) {
  const RecordedTrial trial = trial_of(500);
  const RecordedTrial back = trial_from(trial_bytes(trial), TraceToo::yes);
  EXPECT_EQ(trial_bytes(back), trial_bytes(trial));
  EXPECT_EQ(back.what.level, trial.what.level);
  EXPECT_EQ(back.what.slots, trial.what.slots);
  EXPECT_EQ(back.answer, 1U);
  EXPECT_EQ(back.response_s, 12.125);
  EXPECT_EQ(back.answerable_s, 8.0);
  EXPECT_EQ(back.decision_s(), 4.125);
  EXPECT_EQ(back.switches, 9U);
  EXPECT_EQ(back.at, trial.at);
  ASSERT_EQ(back.axes.size(), 2U);
  EXPECT_EQ(back.axes[0].force_unit, "N·m");
  EXPECT_EQ(back.axes[0].lever, 0.0369);
  EXPECT_TRUE(std::isnan(back.axes[0].contact_position));
  EXPECT_EQ(back.axes[1].contact_direction, -1.0);
  EXPECT_EQ(back.channels.at(0).unit, "K");
  ASSERT_EQ(back.trace.size(), 500U);
  const TraceRow& tick = back.trace[499];
  EXPECT_EQ(tick.slot, 1);
  EXPECT_EQ(tick.row.tick, 506U);
  EXPECT_EQ(tick.row.position[1], 499.0 / 3.0);
  EXPECT_TRUE(std::isnan(tick.row.force_measured[0]));
  EXPECT_EQ(tick.row.channels[0], 799.0);
  EXPECT_EQ(tick.row.write_time_s, 4e-6F);
  EXPECT_EQ(tick.row.flags, schema::flag_soft_switch);
  EXPECT_TRUE(trial_from(trial_bytes(trial), TraceToo::no).trace.empty());
}

// Nobody may learn from its length what was played or answered.
TEST(TrialBytes, AreAsManyWhateverWasPlayedOrAnswered) {
  RecordedTrial trial = trial_of(100);
  const std::size_t length = trial_bytes(trial).size();
  EXPECT_EQ(length, 4096U + 100 * (8 + 8 + 4 + 16 + 1 + 2 * 4 * 8 + 8));
  trial.what = {.tissue = 123456, .pair = {77, 12345}, .slots = {0, 1, 0}};
  EXPECT_EQ(trial_bytes(trial).size(), length);
  trial.what.level = -1.2345678901234567e-300;
  trial.answer = 2;
  trial.switches = 10'000;
  trial.response_s = std::nan("");
  trial.at.clear();
  EXPECT_EQ(trial_bytes(trial).size(), length);
  for (std::size_t switches = 1; switches < 1'000'000; switches *= 10) {
    trial.switches = switches;
    EXPECT_EQ(trial_bytes(trial).size(), length) << switches;
  }
  for (TraceRow& tick : trial.trace) tick.row.force_commanded = {};
  EXPECT_EQ(trial_bytes(trial).size(), length) << "zeros take their room, too";
}

TEST(TrialBytes, KeepWhyATrialIsVoidInTheSameRoom) {
  RecordedTrial trial = trial_of(10);
  const std::size_t length = trial_bytes(trial).size();
  EXPECT_FALSE(trial_from(trial_bytes(trial), TraceToo::no).is_void());
  trial.void_reasons = {VoidReason::fault, VoidReason::slipped};
  trial.answer = no_answer;
  EXPECT_EQ(trial_bytes(trial).size(), length);
  const RecordedTrial back = trial_from(trial_bytes(trial), TraceToo::yes);
  EXPECT_EQ(back.void_reasons, trial.void_reasons);
  EXPECT_EQ(back.answer, no_answer);
}

TEST(TrialBytes, RefuseNamesThatDoNotFit) {
  RecordedTrial trial = trial_of(1);
  trial.axes[0].name.assign(5000, 'x');
  EXPECT_THROW((void)trial_bytes(trial), std::invalid_argument);
  trial = trial_of(1);
  trial.axes.resize(7);
  EXPECT_THROW((void)trial_bytes(trial), std::invalid_argument);
}

TEST(TrialBytes, CutAnywhereAreNone) {
  const auto bytes = trial_bytes(trial_of(3));
  for (std::size_t length = 0; length < bytes.size(); length += length < 4096 ? 97 : 1) {
    EXPECT_THROW((void)trial_from(std::span(bytes).first(length), TraceToo::yes), std::invalid_argument)
        << length;
  }
}

}  // namespace
}  // namespace kerf::bench

#include "sealed/trials/trial_quality.h"

#include <cmath>

#include <gtest/gtest.h>

#include "answers/analysis.h"
#include "bench/sessions/sealed/stored_session.h"

namespace kerf::bench {
namespace {

constexpr double period_s = 0.001;

/// A slot that plays for so many ticks at 1 m/s against a force.
void add_slot(RecordedTrial& trial, std::uint8_t slot, std::size_t ticks, double force_n,
              std::uint32_t flags = 0) {
  for (std::size_t i = 0; i < ticks; ++i) {
    const std::size_t tick = trial.trace.size();
    TraceRow row{.row = {.tick = tick, .time_s = period_s * static_cast<double>(tick)}, .slot = slot};
    row.row.position[0] = period_s * static_cast<double>(tick);
    row.row.force_commanded[0] = -force_n;
    row.row.flags = i == ticks / 2 ? flags : 0;
    trial.trace.push_back(row);
  }
}

RecordedTrial two_slots(double first_n, double second_n, std::uint32_t flags = 0) {
  RecordedTrial trial;
  trial.axes = {{.name = "x", .position_unit = "m", .force_unit = "N"}};
  add_slot(trial, 0, 1001, first_n);
  add_slot(trial, 1, 501, second_n, flags);
  add_slot(trial, 255, 100, 0.0);
  return trial;
}

TEST(TrialQuality, SaysWhatWasFeltOfEachSlot) {
  const TrialQuality quality = *quality_of(two_slots(2.0, 3.0), 2);
  ASSERT_EQ(quality.slots.size(), 2U);
  const SlotFelt& first = quality.slots[0];
  EXPECT_NEAR(first.playing_s, 1.0, 1e-9);
  EXPECT_NEAR(first.contact_s, 1.0, 1e-9);
  EXPECT_NEAR(first.rms_n, 2.0, 1e-9);
  EXPECT_NEAR(first.peak_n, 2.0, 1e-9);
  EXPECT_NEAR(first.travel_m, 1.0, 1e-9);
  EXPECT_NEAR(first.speed_m_s, 1.0, 1e-9);
  EXPECT_NEAR(first.work_j, 2.0, 1e-9) << "2 N over 1 m";
  EXPECT_NEAR(quality.slots[1].work_j, 1.5, 1e-9);
  EXPECT_TRUE(quality.is_felt());
  EXPECT_TRUE(quality.is_sound());
}

TEST(TrialQuality, OfASlotWithoutAForceThatCanBeFeltIsNotFelt) {
  EXPECT_FALSE(quality_of(two_slots(2.0, 0.0), 2)->is_felt());
  EXPECT_FALSE(quality_of(two_slots(2.0, 0.04), 2)->is_felt());
  EXPECT_FALSE(quality_of(two_slots(2.0, 3.0), 3)->is_felt()) << "the third never played";
}

TEST(TrialQuality, IsNotSoundWithAFaultOrANewSoftStartWhileASlotPlays) {
  for (const std::uint32_t flag : {schema::flag_device_fault, schema::flag_law_fault, schema::flag_watchdog,
                                   schema::flag_position_jump, schema::flag_soft_start})
    EXPECT_FALSE(quality_of(two_slots(2.0, 3.0, flag), 2)->is_sound());
  const TrialQuality limited = *quality_of(two_slots(2.0, 3.0, schema::flag_slew_limited), 2);
  EXPECT_TRUE(limited.is_sound());
  EXPECT_EQ(limited.slots[1].limited_ticks, 1U);
  EXPECT_EQ(quality_of(two_slots(2.0, 3.0, schema::flag_missed_deadline), 2)->missed_deadlines, 1U);
}

TEST(TrialQuality, CountsStrokesFromTurnToTurn) {
  RecordedTrial trial;
  trial.axes = {{.name = "x", .position_unit = "m", .force_unit = "N"}};
  for (std::size_t i = 0; i <= 2000; ++i) {
    const double t_s = period_s * static_cast<double>(i);
    TraceRow row{.row = {.tick = i, .time_s = t_s}, .slot = 0};
    // Five strokes of 10 mm in 2 s, with a tremor of 0.5 mm that is none.
    row.row.position[0] = 0.005 * (1.0 - std::cos(2.5 * M_PI * t_s)) + 0.00025 * std::sin(60.0 * t_s);
    trial.trace.push_back(row);
  }
  EXPECT_EQ(quality_of(trial, 1)->slots[0].strokes, 5U);
}

TEST(TrialQuality, IsVoidForWhatTheProtocolSaysAndNothingElse) {
  using R = VoidReason;
  const auto reasons = [](std::uint32_t flag, const TrialRules& rules) {
    return void_reasons_of(*quality_of(two_slots(2.0, 3.0, flag), 2), rules);
  };
  const TrialRules all{.fault = true, .soft_start = true, .limited_ticks = 0, .missed_deadlines = 0};
  EXPECT_EQ(reasons(0, all), std::vector<R>{});
  EXPECT_EQ(reasons(schema::flag_device_fault, all), std::vector<R>{R::fault});
  EXPECT_EQ(reasons(schema::flag_soft_start, all), std::vector<R>{R::soft_start});
  EXPECT_EQ(reasons(schema::flag_slew_limited, all), std::vector<R>{R::limited_ticks});
  EXPECT_EQ(reasons(schema::flag_missed_deadline, all), std::vector<R>{R::missed_deadline});
  EXPECT_EQ(reasons(schema::flag_device_fault | schema::flag_soft_start, all),
            (std::vector<R>{R::fault, R::soft_start}));
  EXPECT_EQ(reasons(schema::flag_slew_limited, {.limited_ticks = 1}), std::vector<R>{}) << "one still counts";
  EXPECT_EQ(reasons(schema::flag_device_fault | schema::flag_missed_deadline, {}), std::vector<R>{});
}

TEST(TrialQuality, IsKnownThroughAPositionThatWasNoNumber) {
  RecordedTrial trial = two_slots(2.0, 3.0);
  trial.trace[400].row.position[0] = std::nan("");
  EXPECT_NEAR(quality_of(trial, 2)->slots[0].travel_m, 0.998, 1e-9) << "without the two ticks around it";
  EXPECT_TRUE(is_explored(*quality_of(trial, 2), {.travel_m = 0.4}));
}

TEST(TrialQuality, IsExploredOnlyWhereEverySlotIs) {
  const TrialQuality quality = *quality_of(two_slots(2.0, 3.0), 2);  // 1 s and 0.5 s, 1 m and 0.5 m
  EXPECT_TRUE(is_explored(quality, {}));
  EXPECT_TRUE(is_explored(quality, {.contact_s = 0.4, .travel_m = 0.4, .force_n = 1.9, .strokes = 1}));
  EXPECT_FALSE(is_explored(quality, {.contact_s = 0.6}));
  EXPECT_FALSE(is_explored(quality, {.travel_m = 0.6}));
  EXPECT_FALSE(is_explored(quality, {.force_n = 2.1}));
  EXPECT_FALSE(is_explored(quality, {.strokes = 2}));
}

TEST(TrialQuality, IsUnknownWithoutATrace) { EXPECT_FALSE(quality_of(RecordedTrial(), 2)); }

TEST(Sessions, SayWhichTrialsWereFeltAndSoundAndWhatTheOthersSay) {
  const test::StoredSession session;
  {
    SessionStore store = session.run();
    for (const TrialPlan& plan : test::set_up().plan) store.append(test::answered(plan, plan.slots[2]));
    store.close();
  }
  const SessionStore store = session.read();
  const Study study = study_of({&store});
  ASSERT_EQ(study.judgements.size(), 3U);
  EXPECT_EQ(study.judgements[1].is_felt, false) << "X never played";
  EXPECT_EQ(study.judgements[1].is_sound, true);
  const Analysis found = analyse(study, {.bootstrap = 0});
  EXPECT_EQ(found.quality.known, 2U);
  EXPECT_EQ(found.quality.unfelt, 2U);
  EXPECT_EQ(found.quality.without, 0U);
  EXPECT_TRUE(std::isnan(found.quality.p_value));
}

}  // namespace
}  // namespace kerf::bench

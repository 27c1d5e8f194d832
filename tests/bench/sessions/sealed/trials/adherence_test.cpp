#include "sealed/trials/adherence.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "sealed/trials/trial_bytes.h"
#include "sealed/trials/trial_quality.h"

namespace kerf::bench {
namespace {

constexpr double tick_s = 0.001;

const GuidedMotion strokes{.kind = GuideKind::strokes,
                           .from = 0.02,
                           .to = -0.02,
                           .stroke_s = 0.5,
                           .pause_s = 0.1,
                           .position_unit = "m",
                           .force_unit = "N"};

/// One slot of a trial that was led from 3 s on the guide's clock, with the tool where `where` says.
RecordedTrial led_trial(const GuidedMotion& guide, std::size_t ticks,
                        const std::function<double(double guide_s)>& where, double guide_force_n = 0.0) {
  RecordedTrial trial;
  trial.axes = {{.name = "x", .position_unit = "m", .force_unit = "N"},
                {.name = "y", .position_unit = "m", .force_unit = "N"}};
  trial.channels = channels_of_guide(trial.axes[0]);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const double guide_s = 3.0 + tick_s * static_cast<double>(tick);
    TraceRow row{.row = {.tick = tick, .time_s = tick_s * static_cast<double>(tick)}, .slot = 0};
    row.row.position[0] = where(guide_s);
    row.row.channels = {guide_s, guide.at(guide_s).position, guide_force_n};
    row.row.force_commanded[0] = -2.0 + guide_force_n;
    trial.trace.push_back(row);
  }
  return trial;
}

TEST(Adherence, FindsByHowMuchTheToolCameLater) {
  GuidedMotion sine = strokes;
  sine.kind = GuideKind::sine;
  sine.frequency_hz = 0.8;
  for (const GuidedMotion& guide : {strokes, sine}) {
    for (const double late_s : {-0.1, 0.0, 0.0823, 0.25}) {
      const RecordedTrial trial = led_trial(
          guide, 3000, [&](double guide_s) { return 0.5 * guide.at(guide_s - late_s).position + 0.01; });
      EXPECT_NEAR(guide_lags_s(trial, guide, 2)[0], late_s, 5e-4) << "whatever its extent and middle";
      EXPECT_TRUE(std::isnan(guide_lags_s(trial, guide, 2)[1])) << "it did not play";
    }
  }
}

TEST(Adherence, TellsNoLagOfAToolThatDidNotFollow) {
  EXPECT_TRUE(std::isnan(guide_lags_s(led_trial(strokes, 3000, [](double) { return 0.0; }), strokes, 1)[0]));
  const auto shivers = [](double guide_s) { return 0.01 * std::sin(40.0 * guide_s); };
  EXPECT_TRUE(std::isnan(guide_lags_s(led_trial(strokes, 3000, shivers), strokes, 1)[0]));
  const auto follows = [](double guide_s) { return strokes.at(guide_s - 0.05).position; };
  EXPECT_TRUE(std::isnan(guide_lags_s(led_trial(strokes, 500, follows), strokes, 1)[0])) << "too short";
  RecordedTrial unled = led_trial(strokes, 3000, follows);
  unled.channels.clear();
  EXPECT_TRUE(std::isnan(guide_lags_s(unled, strokes, 1)[0]));
  EXPECT_TRUE(std::isnan(quality_of(unled, 1)->slots[0].off_target));
}

TEST(Adherence, IsTheDistanceToTheTargetAndTheLawsForceAlone) {
  const RecordedTrial trial = led_trial(
      strokes, 2401, [](double guide_s) { return strokes.at(guide_s).position + 0.003; }, 0.5);
  const SlotFelt slot = quality_of(trial, 1)->slots[0];
  EXPECT_NEAR(slot.off_target, 0.003, 1e-12);
  EXPECT_NEAR(slot.rms_n, 2.0, 1e-9) << "without the guide's 0.5 N";
  EXPECT_NEAR(slot.peak_n, 2.0, 1e-9);
  EXPECT_NEAR(slot.guide_rms_n, 0.5, 1e-9);
  EXPECT_NEAR(slot.guide_peak_n, 0.5, 1e-9);
  EXPECT_NEAR(slot.work_j, 0.0, 1e-6) << "there and back against the law";
  EXPECT_EQ(slot.strokes, 4U);
  EXPECT_NEAR(slot.strokes_per_s(), 4.0 / 2.4, 1e-9);
  // The middle 20 ms of a stroke: 1.875 times the mean speed of 80 mm/s, and a little less.
  EXPECT_NEAR(slot.peak_speed_m_s, 1.875 * 0.08, 1e-3);
}

TEST(Adherence, IsReadBackFromTheSeal) {
  const auto off = [](double guide_s) { return strokes.at(guide_s).position + 0.003; };
  const RecordedTrial trial = trial_from(trial_bytes(led_trial(strokes, 1500, off, 0.5)), TraceToo::yes);
  EXPECT_EQ(led_axis_of(trial), 0U);
  EXPECT_NEAR(quality_of(trial, 1)->slots[0].off_target, 0.003, 1e-12);
}

}  // namespace
}  // namespace kerf::bench

#include "sealed/trials/slot_levels.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/sessions/sealed/stored_session.h"

namespace kerf::bench {
namespace {

constexpr double ramp_s = 0.25;

Protocol protocol_with_a_ramp() {
  Protocol protocol = test::set_up().protocol;
  protocol.ramp_s = ramp_s;
  protocol.rate_hz = 1000.0;
  return protocol;
}

/// Two seconds of slot A at 2 N, with 0.5 N at 100 Hz on them in some of the ticks.
template <typename Shakes>
RecordedTrial trial_that(const Shakes& shakes) {
  RecordedTrial trial = test::answered(test::set_up().plan[1], 1, 0);
  for (std::size_t i = 0; i < 2000; ++i) {
    const double time_s = 0.001 * static_cast<double>(i);
    TraceRow tick{.row = {.tick = i, .time_s = time_s}, .slot = 0};
    tick.row.force_commanded[0] =
        2.0 + (shakes(time_s) ? 0.5 * std::sin(2.0 * std::numbers::pi * 100.0 * time_s) : 0.0);
    trial.trace.push_back(tick);
  }
  return trial;
}

TEST(SlotLevels, AreThoseOfTheForcesOfTheSlot) {
  const auto levels = slot_levels(trial_that([](double) { return true; }), protocol_with_a_ramp());
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_NEAR(levels[0].rms_n, std::sqrt(4.0 + 0.125), 1e-3);
  EXPECT_NEAR(levels[0].vibration_n, 0.5 / std::numbers::sqrt2, 0.02);
  EXPECT_EQ(levels[0].limited_share, 0.0);
  EXPECT_TRUE(std::isnan(levels[1].rms_n)) << "it never played";
}

// A switch is a ramp of the force, whatever it leads to.
TEST(SlotLevels, HaveNoVibrationOfASwitch) {
  const auto levels =
      slot_levels(trial_that([](double time_s) { return time_s < ramp_s - 0.001; }), protocol_with_a_ramp());
  EXPECT_LT(levels[0].vibration_n, 1e-6);
}

}  // namespace
}  // namespace kerf::bench

#include "replay/force_events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

const ForceEventOptions options{.jnd = {.weber_fraction = 0.07, .threshold = 0.05}};

/// A force that rises by 2 N/s from 0.1 s on, breaks by half within 2 ms at 1.1 s (2 N), goes on as before
/// and fades away over a second from 1.6 s (2 N).
std::vector<double> times() {
  std::vector<double> all;
  for (int i = 0; i < 3000; ++i) all.push_back(1e-3 * i);
  return all;
}
double force_at(double time_s) {
  if (time_s < 0.1) return 0.0;
  if (time_s < 1.1) return 2.0 * (time_s - 0.1);
  if (time_s < 1.102) return 2.0 - 500.0 * (time_s - 1.1);
  if (time_s < 1.6) return 1.0 + 2.0 * (time_s - 1.1);
  return 2.0 * std::max(0.0, 1.0 - (time_s - 1.6));
}
std::vector<double> forces(double late_s = 0.0, double sign = 1.0) {
  std::vector<double> all;
  for (const double time_s : times()) all.push_back(sign * force_at(time_s - late_s));
  return all;
}

TEST(ForceEvents, AreContactDropAndReleaseAtTheirTimes) {
  for (const double sign : {1.0, -1.0}) {
    const auto events = find_force_events(times(), forces(0.0, sign), options);
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[0].kind, ForceEventKind::contact);
    EXPECT_NEAR(events[0].time_s, 0.15, 1.1e-3);  // 2 * 0.05 N
    EXPECT_EQ(events[1].kind, ForceEventKind::drop);
    EXPECT_NEAR(events[1].time_s, 1.1 + 0.14 / 500.0, 1.1e-3);  // a JND of 7 % of 2 N
    EXPECT_NEAR(events[1].size, 1.0, 0.01);
    EXPECT_EQ(events[2].kind, ForceEventKind::release);
    EXPECT_NEAR(events[2].time_s, 2.575, 1.1e-3);  // half of the threshold
  }
}

TEST(ForceEvents, AreNotMadeByAForceThatHoversAtTheThreshold) {
  std::vector<double> hovering;
  for (std::size_t i = 0; i < times().size(); ++i) hovering.push_back(i % 2 == 0 ? 0.11 : 0.08);
  EXPECT_EQ(find_force_events(times(), hovering, options).size(), 1U);
}

TEST(ForceEvents, AreNotDropsThatNoiseAloneMakes) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<double> smooth;
  for (const double time_s : times()) smooth.push_back(1.0 + std::sin(2.0 * time_s) + noise(random));
  for (const ForceEvent& event : find_force_events(times(), smooth, options))
    EXPECT_NE(event.kind, ForceEventKind::drop) << event.time_s;
  std::vector<double> breaking = forces();
  for (double& force : breaking) force += noise(random);
  const auto events = find_force_events(times(), breaking, options);
  const auto drop = std::ranges::find(events, ForceEventKind::drop, &ForceEvent::kind);
  ASSERT_NE(drop, events.end());
  EXPECT_NEAR(drop->time_s, 1.1, 2.1e-3);
  EXPECT_NEAR(drop->size, 1.0, 0.15);
}

TEST(ForceEvents, PassOverWhatWasNotMeasured) {
  std::vector<double> force = forces();
  for (std::size_t i = 500; i < 600; ++i) force[i] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(find_force_events(times(), force, options).size(), 3U);
}

TEST(ForceEvents, ThatComeLateAreLateByTheirDifference) {
  const auto recorded = find_force_events(times(), forces(), options);
  const auto matches = match_events(recorded, find_force_events(times(), forces(0.012), options), 0.05);
  for (const EventMatch& match : matches) {
    EXPECT_EQ(match.recorded, 1U);
    ASSERT_EQ(match.late_s.size(), 1U);
    EXPECT_NEAR(match.worst_s(), 0.012, 1.1e-3);
  }
  EXPECT_TRUE(match_events(recorded, {}, 0.05)[0].late_s.empty());
  EXPECT_TRUE(
      match_events(recorded, find_force_events(times(), forces(0.06), options), 0.05)[2].late_s.empty());
}

TEST(ForceEvents, ArePairedOneToOneTheNearestFirst) {
  const std::vector<ForceEvent> recorded{{.time_s = 1.0}, {.time_s = 1.03}};
  const std::vector<ForceEvent> rendered{{.time_s = 1.02}};
  const EventMatch match = match_events(recorded, rendered, 0.05)[0];
  ASSERT_EQ(match.late_s.size(), 1U);
  EXPECT_NEAR(match.late_s[0], -0.01, 1e-12);
}

}  // namespace
}  // namespace kerf::bench

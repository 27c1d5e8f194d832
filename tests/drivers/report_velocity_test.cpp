#include "kerf/drivers/report_velocity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

constexpr std::int64_t ms = 1'000'000;

/// One axis of a device at 1 kHz, like a Falcon's.
DeviceInfo falcon_like() {
  DeviceInfo info;
  info.axes = {{.name = "z", .resolution = 0.05e-3, .speed_limit = 5.0, .acceleration_limit = 200.0}};
  info.report_jitter_s = 1e-3;
  return info;
}

/// What ticks each millisecond see of reports that arrive at times of their own, from a device that moves as
/// `position_at(seconds)` says.
std::vector<double> seen_by_ticks(const std::vector<std::int64_t>& arrivals,
                                  const std::function<double(double)>& position_at) {
  const DeviceInfo info = falcon_like();
  ReportVelocity velocity(1);
  std::vector<double> seen;
  std::size_t next = 0;
  for (std::int64_t tick = arrivals.front() + ms / 2; tick < arrivals.back(); tick += ms) {
    while (next < arrivals.size() && arrivals[next] <= tick) ++next;
    const std::int64_t at = arrivals[next - 1];
    velocity.update({position_at(1e-9 * static_cast<double>(at))}, at, info);
    seen.push_back(velocity.velocity(0));
  }
  return seen;
}

// Differenced over ticks, a report that comes 30 us early or late reads 0.179 to 0.221 m/s.
TEST(ReportVelocity, IsThatOfTheReportsAndNotOfTheTicks) {
  std::vector<std::int64_t> arrivals;
  for (std::int64_t i = 0; i < 2000; ++i) {
    arrivals.push_back(1000 * ms + i * ms + (i % 2 == 0 ? 30'000 : -30'000));
  }
  const auto seen = seen_by_ticks(arrivals, [](double time_s) { return 0.2 * time_s; });
  for (std::size_t i = 100; i < seen.size(); ++i) EXPECT_NEAR(seen[i], 0.2, 0.001) << i;
}

TEST(ReportVelocity, IsHeldInATickWithoutAReport) {
  std::vector<std::int64_t> arrivals;
  for (std::int64_t i = 0; i < 2000; ++i) {
    if (i % 7 != 3) arrivals.push_back(1000 * ms + i * ms);
  }
  const auto seen = seen_by_ticks(arrivals, [](double time_s) { return 0.2 * time_s; });
  for (std::size_t i = 100; i < seen.size(); ++i) EXPECT_NEAR(seen[i], 0.2, 0.001) << i;
}

/// The velocity after each of some positions a millisecond apart.
std::vector<double> after_each(const std::vector<double>& positions) {
  const DeviceInfo info = falcon_like();
  ReportVelocity velocity(1);
  std::vector<double> all;
  std::int64_t at = 1000 * ms;
  for (const double position : positions) {
    velocity.update({position}, at += ms, info);
    all.push_back(velocity.velocity(0));
  }
  return all;
}

// 128 counts of a Falcon's arm are 4 to 5 mm. Without the rule: 0.59 m/s for a tick, and still 0.03 m/s after
// ten.
TEST(ReportVelocity, LeavesAFlippedBitOut) {
  std::vector<double> positions;
  for (int i = 0; i < 400; ++i) positions.push_back(0.1e-3 * i);
  std::vector<double> flipped = positions;
  flipped[200] += 4.5e-3;
  flipped[250] -= 4.5e-3;
  const auto well = after_each(positions);
  const auto seen = after_each(flipped);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i], well[i], 1e-4) << i;
}

TEST(ReportVelocity, GoesOnFromWhereTwoReportsAgree) {
  std::vector<double> positions;
  for (int i = 0; i < 400; ++i) positions.push_back(0.1e-3 * i + (i >= 200 ? 20e-3 : 0.0));
  const auto seen = after_each(positions);
  for (std::size_t i = 100; i < seen.size(); ++i) EXPECT_NEAR(seen[i], 0.1, 0.015) << i;
  EXPECT_NEAR(seen.back(), 0.1, 1e-4);
}

// The fastest that a hand does: from rest to 1 m/s at 200 m/s^2, and a hard stop.
TEST(ReportVelocity, DoubtsNoHand) {
  std::vector<double> positions;
  double speed = 0.0;
  double position = 0.0;
  for (int i = 0; i < 60; ++i) {
    speed = i < 20 ? 0.0 : i < 40 ? std::min(1.0, speed + 0.2) : 0.0;
    position += 1e-3 * speed;
    positions.push_back(position);
  }
  VelocityFilter plain;
  const auto seen = after_each(positions);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double now_s = 1e-3 * static_cast<double>(i);
    EXPECT_NEAR(seen[i], plain.update(0, positions[i], now_s), 1e-9) << i;
    plain.advance(now_s);
  }
}

}  // namespace
}  // namespace kerf::drivers

#include "loop/plausibility.h"

#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/measured_data.h"

namespace kerf::bench {
namespace {

struct Reading {
  double time_s;
  double theta_rad;
};

/// Time in ms and angle in degrees stand in the last two columns; lines that were torn are left out.
std::vector<Reading> hand_on_a_punch(const std::string& name) {
  std::ifstream file(test::measured_file(name));
  std::vector<Reading> all;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    double ignored = 0.0;
    double degrees = 0.0;
    double ms = 0.0;
    if (!(words >> ignored >> ignored >> ignored >> degrees >> ms)) continue;
    const Reading next{1e-3 * ms, degrees * std::numbers::pi / 180.0};
    if (all.empty() || next.time_s > all.back().time_s) all.push_back(next);
  }
  return all;
}

/// The handle of sim:scissors, read by the punch's potentiometer.
const drivers::DeviceInfo punch{
    .axes = {{.name = "theta", .resolution = 4.36e-3, .speed_limit = 50.0, .acceleration_limit = 20'000.0}}};

TEST(Plausibility, TakesNoMotionOfAMeasuredHandForAJumpAndSeesOneThatIsPutIntoIt) {
  const std::string slow = "meniscus/9_meniscus_slow_1824.txt";
  const std::string fast = "meniscus/8_blank_fast_1821.txt";
  KERF_NEEDS_DATA(slow, fast);
  for (const std::string& name : {slow, fast}) {
    const std::vector<Reading> hand = hand_on_a_punch(name);
    ASSERT_GT(hand.size(), 10'000U) << name;
    Plausibility honest(punch);
    double last_s = hand.front().time_s;
    for (const Reading& reading : hand) {
      ASSERT_EQ(honest.judge({.position = {reading.theta_rad}}, reading.time_s - last_s), Trust::believed)
          << name << " at " << reading.time_s << " s";
      last_s = reading.time_s;
    }
    Plausibility slipped(punch);
    last_s = hand.front().time_s;
    Trust trust = Trust::believed;
    for (std::size_t row = 0; row < 1000; ++row) {
      const double offset = row < 500 ? 0.0 : 0.5;
      trust = slipped.judge({.position = {hand[row].theta_rad + offset}}, hand[row].time_s - last_s);
      last_s = hand[row].time_s;
      EXPECT_EQ(trust == Trust::believed, row < 500) << name << " row " << row;
    }
    EXPECT_EQ(trust, Trust::slipped);
  }
}

/// After five reports at 0, a millisecond apart.
Plausibility at_rest() {
  Plausibility rest(punch);
  for (int report = 0; report < 5; ++report) EXPECT_EQ(rest.judge({}, 1e-3), Trust::believed);
  return rest;
}

TEST(Plausibility, TakesAWayForAJumpThatSpeedWouldAllowAndAccelerationDoesNot) {
  // In the next millisecond 10 rad/s, which it may have had unseen, and 20,000 rad/s^2 make 20 mrad, and two
  // encoder steps 9 mrad; 50 rad/s alone would make 50.
  for (const double way : {0.025, 0.035}) {
    Plausibility tool = at_rest();
    EXPECT_EQ(tool.judge({.position = {way}}, 1e-3), way < 0.03 ? Trust::believed : Trust::jumped) << way;
  }
}

TEST(Plausibility, BelievesNoReportMoreForHearingItAgain) {
  Plausibility tool = at_rest();
  ASSERT_EQ(tool.judge({.position = {0.4}}, 1e-3), Trust::jumped);
  for (const double age_s : {1e-3, 2e-3}) {
    EXPECT_EQ(tool.judge({.position = {0.4}, .age_s = age_s}, 1e-3), Trust::doubted) << age_s;
  }
  ASSERT_EQ(tool.judge({.position = {0.4}}, 1e-3), Trust::doubted);
  ASSERT_EQ(tool.judge({.position = {0.4}}, 1e-3), Trust::slipped);
  EXPECT_EQ(tool.judge({.position = {0.4}, .age_s = 1e-3}, 1e-3), Trust::slipped);
}

}  // namespace
}  // namespace kerf::bench

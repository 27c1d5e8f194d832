#include "loop/safety.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const std::vector<drivers::AxisInfo> scissors{
    {.name = "theta",
     .lever = 0.04,
     .resolution = 1e-3,
     .force_limit = 7.0,
     .slew_limit = 2000.0,
     .speed_limit = 50.0},
    {.name = "x_s", .lever = 1.0, .force_limit = 100.0, .slew_limit = 20000.0}};

Command applied(Safety& safety, Command command, double time_s = 1.0) {
  safety.apply(time_s, command);
  return command;
}

std::uint32_t judged(Safety& safety, double theta, double elapsed_s = 1e-3) {
  return safety.judge(drivers::Status::ok, {.position = {theta}}, elapsed_s);
}

TEST(Safety, KeepsEachAxisWithinItsOwnLimit) {
  Safety safety(scissors, {.period_s = 1.0, .soft_start_s = 0.0});
  const Command command = applied(safety, {.force = {-9.0, 90.0}});
  EXPECT_EQ(command.force[0], -7.0);
  EXPECT_EQ(command.force[1], 90.0);
  EXPECT_EQ(command.flags, schema::flag_force_limited);
}

TEST(Safety, ChangesAForceNoFasterThanItsSlewLimit) {
  Safety safety(scissors, {.soft_start_s = 0.0});
  for (const double expected : {2.0, 4.0, 5.0}) {
    const Command command = applied(safety, {.force = {5.0}});
    EXPECT_EQ(command.force[0], expected);
    EXPECT_EQ(command.flags, expected < 5.0 ? schema::flag_slew_limited : 0U);
  }
}

TEST(Safety, GivesZeroAtOnceWhereTheForceIsReleasedAndComesBackSoftly) {
  Safety safety(scissors, {.soft_start_s = 0.1});
  (void)applied(safety, {.force = {1.0, 3.0}}, 0.2);
  const Command released = applied(safety, {.force = {1.0, 3.0}, .is_released = true}, 0.3);
  EXPECT_EQ(released.force, drivers::Axes{});
  EXPECT_EQ(released.flags, 0U);
  const Command back = applied(safety, {.force = {1.0, 3.0}}, 0.35);
  EXPECT_NEAR(back.force[0], 0.5, 1e-12);
  EXPECT_EQ(back.flags, schema::flag_soft_start);
}

TEST(Safety, ZeroesEveryAxisOnOneBadNumber) {
  Safety safety(scissors, {.soft_start_s = 0.0});
  (void)applied(safety, {.force = {2.0, 3.0}});
  for (const double bad : {not_a_number, std::numeric_limits<double>::infinity()}) {
    const Command command = applied(safety, {.force = {2.0, bad}});
    EXPECT_EQ(command.force, drivers::Axes{});
    EXPECT_EQ(command.flags, schema::flag_law_fault);
  }
}

TEST(Safety, TrustsNoForceBesideAFault) {
  for (const schema::Flag fault : {schema::flag_law_fault, schema::flag_device_fault,
                                   schema::flag_position_jump, schema::flag_watchdog}) {
    Safety safety(scissors, {.soft_start_s = 0.0});
    EXPECT_EQ(applied(safety, {.force = {1.0}, .flags = fault}).force[0], 0.0);
  }
}

TEST(Safety, StartsSoftlyAfterEveryFault) {
  Safety safety(scissors, {.soft_start_s = 0.25});
  (void)applied(safety, {.flags = schema::flag_device_fault}, 3.0);
  EXPECT_DOUBLE_EQ(applied(safety, {.force = {1.0}}, 3.125).force[0], 0.5);
  EXPECT_EQ(applied(safety, {.force = {1.0}}, 3.125).flags, schema::flag_soft_start);
  EXPECT_EQ(applied(safety, {.force = {1.0}}, 3.25).flags, 0U);
}

TEST(Safety, BelievesNoAnswerThatIsNone) {
  Safety safety(scissors, {});
  EXPECT_EQ(safety.judge(drivers::Status::fault, {}, 1e-3), schema::flag_device_fault);
  EXPECT_EQ(safety.judge(drivers::Status::lost, {}, 1e-3), schema::flag_device_fault);
  EXPECT_EQ(judged(safety, not_a_number), schema::flag_device_fault);
  EXPECT_EQ(safety.judge(drivers::Status::ok, {.velocity = {0.0, not_a_number}}, 1e-3),
            schema::flag_device_fault);
  EXPECT_EQ(judged(safety, 0.3), 0U) << "anywhere at first";
}

TEST(Safety, TakesAForceThatNobodyMeasuredForAGapAndNotForAFault) {
  Safety safety(scissors, {.soft_start_s = 0.0});
  EXPECT_EQ(safety.judge(drivers::Status::ok, {.force_measured = {not_a_number, not_a_number}}, 1e-3), 0U);
  EXPECT_EQ(applied(safety, {.force = {1.0}}).force[0], 1.0);
}

TEST(Safety, BelievesAPositionThatTheHandCanReachInTheTimeThatHasPassed) {
  Safety safety(scissors, {});
  EXPECT_EQ(judged(safety, 0.0), 0U);
  EXPECT_EQ(judged(safety, 0.0519), 0U) << "50 rad/s for 1 ms, and two encoder steps of 1 mrad";
  EXPECT_EQ(judged(safety, 0.0519 + 0.0521), schema::flag_position_jump);
  EXPECT_EQ(judged(safety, 0.104), 0U) << "the new place is believed from then on";
  EXPECT_EQ(judged(safety, 0.504, 8e-3), 0U) << "eight periods were missed";
  EXPECT_EQ(judged(safety, not_a_number), schema::flag_device_fault);
  EXPECT_EQ(judged(safety, 0.604), 0U) << "2 ms after the last reading that could be believed";
}

TEST(Safety, HasNoOpinionOnAnAxisWithoutASpeedLimit) {
  Safety safety(scissors, {});
  for (const double x : {0.0, 1000.0}) {
    EXPECT_EQ(safety.judge(drivers::Status::ok, {.position = {0.0, x}}, 1e-3), 0U);
  }
}

TEST(Safety, LetsThePassivityControllerActOnlyIfAsked) {
  for (const bool asked : {false, true}) {
    Safety safety(scissors, {.soft_start_s = 0.0, .passivity_control = asked});
    const auto read = [&](double x_s) {
      (void)safety.judge(drivers::Status::ok, {.position = {0.0, x_s}}, 1e-3);
    };
    read(0.0);
    (void)applied(safety, {.force = {0.0, 2.0}});
    read(0.001);  // 2 mJ were given
    Command command;
    safety.apply(1.0, command);  // at the 1 m/s of that millimetre, whatever the driver's filter says
    EXPECT_EQ(command.flags & schema::flag_passivity_control, asked ? schema::flag_passivity_control : 0U);
    EXPECT_NEAR(command.force[1], asked ? -2.0 : 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace kerf::bench

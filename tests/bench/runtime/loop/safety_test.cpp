#include "loop/safety.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const drivers::DeviceInfo scissors{
    .axes = {{.name = "theta",
              .lever = 0.04,
              .resolution = 1e-3,
              .force_limit = 7.0,
              .slew_limit = 2000.0,
              .speed_limit = 50.0},
             {.name = "x_s", .lever = 1.0, .force_limit = 100.0, .slew_limit = 20000.0}}};

Command applied(Safety& safety, Command command, int ticks = 1) {
  Command last;
  for (int tick = 0; tick < ticks; ++tick) {
    last = command;
    safety.apply(last);
  }
  return last;
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

TEST(Safety, CommandsNoForceOnceItIsReleased) {
  Safety safety(scissors, {.soft_start_s = 0.0});
  Command command{.force = {1.0, 3.0}};
  safety.release(command);
  EXPECT_EQ(command.force, drivers::Axes{});
}

TEST(Safety, GivesZeroAtOnceWhereTheForceIsReleasedAndComesBackSoftly) {
  Safety safety(scissors, {.soft_start_s = 0.1});
  (void)applied(safety, {.force = {1.0, 3.0}}, 200);
  const Command released = applied(safety, {.force = {1.0, 3.0}, .is_released = true});
  EXPECT_EQ(released.force, drivers::Axes{});
  EXPECT_EQ(released.flags, 0U);
  const Command back = applied(safety, {.force = {1.0, 3.0}}, 50);
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
  (void)applied(safety, {.flags = schema::flag_device_fault});
  EXPECT_NEAR(applied(safety, {.force = {1.0}}, 125).force[0], 0.5, 1e-12);
  EXPECT_EQ(applied(safety, {.force = {1.0}}, 124).flags, schema::flag_soft_start);
  EXPECT_EQ(applied(safety, {.force = {1.0}}).flags, 0U);
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

TEST(Safety, TakesThePositionForTrueThatTheHandCanReachInTheTimeThatHasPassed) {
  Safety safety(scissors, {});
  EXPECT_EQ(judged(safety, 0.0), 0U);
  EXPECT_EQ(judged(safety, 0.0519), 0U) << "50 rad/s for 1 ms, and two encoder steps of 1 mrad";
  EXPECT_EQ(judged(safety, 0.4519, 8e-3), 0U) << "eight periods were missed";
  EXPECT_EQ(judged(safety, not_a_number), schema::flag_device_fault);
  EXPECT_EQ(judged(safety, 0.5519), 0U) << "2 ms after the last reading that could be believed";
  EXPECT_EQ(judged(safety, 0.5519 + 0.0521), schema::flag_position_jump);
}

TEST(Safety, LetsTheForceBackByItselfAfterAReadingInWhichABitWasTurned) {
  Safety safety(scissors, {.soft_start_s = 0.1});
  for (int tick = 0; tick < 200; ++tick) {
    EXPECT_EQ(judged(safety, 1e-3 * tick), 0U);
    (void)applied(safety, {.force = {1.0}});
  }
  EXPECT_EQ(judged(safety, 1e-3 * (200 + 512)), schema::flag_position_jump);
  EXPECT_EQ(applied(safety, {.flags = schema::flag_position_jump}).force[0], 0.0);
  EXPECT_EQ(judged(safety, 1e-3 * 201), schema::flag_zero_held);
  EXPECT_EQ(applied(safety, {.flags = schema::flag_zero_held}).force[0], 0.0);
  EXPECT_FALSE(safety.holds_zero()) << "there is nothing to confirm yet";
  EXPECT_EQ(judged(safety, 1e-3 * 202), 0U) << "two reports agree with the place before";
  EXPECT_NEAR(applied(safety, {.force = {1.0}}).force[0], 0.01, 1e-12) << "along the ramp";
}

TEST(Safety, HoldsZeroAfterAnEncoderSlippedUntilSomebodyConfirms) {
  Safety safety(scissors, {.soft_start_s = 0.1});
  for (const double theta : {0.0, 0.0, 0.3, 0.3}) (void)judged(safety, theta);
  for (int tick = 0; tick < 1000; ++tick) {
    EXPECT_EQ(judged(safety, 0.3), schema::flag_zero_held);
    EXPECT_EQ(applied(safety, {.flags = schema::flag_zero_held}).force[0], 0.0);
  }
  EXPECT_TRUE(safety.holds_zero());
  safety.confirm();
  EXPECT_EQ(judged(safety, 0.3), 0U);
  EXPECT_NEAR(applied(safety, {.force = {1.0}}).force[0], 0.01, 1e-12) << "along the ramp";
}

TEST(Safety, TakesTheDevicesOwnButtonForAConfirmation) {
  drivers::DeviceInfo with_button = scissors;
  with_button.button_channel = 2;
  Safety safety(with_button, {});
  const auto read = [&](double theta, double button) {
    drivers::Sample sample{.position = {theta}};
    sample.channels[2] = button;
    return safety.judge(drivers::Status::ok, sample, 1e-3);
  };
  (void)read(0.0, 1.0);
  for (int tick = 0; tick < 5; ++tick) (void)read(0.3, 1.0);
  EXPECT_EQ(read(0.3, 1.0), schema::flag_zero_held) << "held down since before the jump confirms nothing";
  EXPECT_EQ(read(0.3, 0.0), schema::flag_zero_held);
  (void)read(0.3, 4.0);
  EXPECT_EQ(read(0.3, 4.0), 0U);
}

TEST(Safety, HasNoOpinionOnAnAxisWithoutASpeedLimit) {
  Safety safety(scissors, {});
  for (const double x : {0.0, 1000.0}) {
    EXPECT_EQ(safety.judge(drivers::Status::ok, {.position = {0.0, x}}, 1e-3), 0U);
  }
}

TEST(Safety, CountsTheRampInTicksThatWereExecuted) {
  for (const double stall_s : {0.011, 0.05, 0.1, 0.3, 2.0, 60.0}) {
    Safety safety(scissors, {.soft_start_s = 0.25});
    (void)judged(safety, 0.0);
    (void)applied(safety, {.force = {7.0}}, 500);
    EXPECT_EQ(safety.judge(drivers::Status::ok, {}, stall_s, true), schema::flag_watchdog);
    double last = applied(safety, {.force = {7.0}, .flags = schema::flag_watchdog}).force[0];
    EXPECT_EQ(last, 0.0);
    for (int tick = 0; tick < 250; ++tick) {
      (void)judged(safety, 0.0, tick == 0 ? stall_s : 1e-3);
      const double force = applied(safety, {.force = {7.0}}).force[0];
      EXPECT_LE(force - last, 7.0 * 1e-3 / 0.25 + 1e-12) << "after " << stall_s << " s";
      last = force;
    }
    EXPECT_NEAR(last, 7.0, 1e-9);
  }
}

TEST(Safety, LetsThePassivityControllerActOnlyIfAsked) {
  for (const bool asked : {false, true}) {
    Safety safety(scissors, {.soft_start_s = 0.0, .passivity_control = asked});
    const auto read = [&](double x_s) {
      (void)safety.judge(drivers::Status::ok, {.position = {0.0, x_s}}, 1e-3);
    };
    read(0.0);
    (void)applied(safety, {.force = {0.0, 2.0}, .stored_change_j = 0.0});
    read(0.001);  // 2 mJ were given
    const Command command = applied(safety, {.stored_change_j = 0.0});
    EXPECT_EQ(command.flags & schema::flag_passivity_control, asked ? schema::flag_passivity_control : 0U);
    EXPECT_NEAR(command.force[1], asked ? -2.0 : 0.0, 1e-12)
        << "at the 1 m/s of that millimetre, whatever the driver's filter says";
  }
}

TEST(Safety, DragsNothingInFreeAirAfterAStallInWhichTheHandWithdrew) {
  Safety safety(scissors, {.soft_start_s = 0.0, .passivity_control = true});
  const auto read = [&](double x_s, double elapsed_s, bool stalled = false) {
    return safety.judge(drivers::Status::ok, {.position = {0.0, x_s}}, elapsed_s, stalled);
  };
  (void)read(0.0, 1e-3);
  for (int tick = 0; tick < 10; ++tick) {
    (void)read(0.0, 1e-3);
    (void)applied(safety, {.force = {0.0, -5.0}, .stored_change_j = 0.0});
  }
  EXPECT_EQ(read(-0.06, 0.3, true), schema::flag_watchdog);  // the watchdog let go of it meanwhile
  (void)applied(safety, {.flags = schema::flag_watchdog});
  for (int tick = 1; tick < 600; ++tick) {
    (void)read(-0.06 + 5e-5 * tick, 1e-3);
    const Command free = applied(safety, {.stored_change_j = 0.0});
    ASSERT_EQ(free.force, drivers::Axes{}) << "tick " << tick;
    ASSERT_EQ(free.flags, 0U);
  }
  EXPECT_EQ(safety.observer().least_j(), 0.0) << "and nothing is booked that no force did";
}

}  // namespace
}  // namespace kerf::bench

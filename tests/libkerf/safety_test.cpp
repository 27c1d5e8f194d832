#include "loop/safety.h"

#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "laws/law_file.h"
#include "libkerf/opened.h"
#include "loop/command.h"
#include "support/allocation_counter.h"

namespace kerf {
namespace {

constexpr double period_s = 1e-3;
constexpr kerf_limits limits{
    .force = 3.0, .slew = 10.0, .speed = 2.0, .acceleration = 200.0, .resolution = 1e-5};

using OpenSafety = std::unique_ptr<kerf_safety, decltype(&kerf_safety_destroy)>;

OpenSafety safety_for(const test::OpenLaw& law, const kerf_safety_options* options = nullptr) {
  kerf_safety* safety = nullptr;
  EXPECT_EQ(kerf_safety_create(law.get(), &limits, options, &safety, nullptr, 0), KERF_OK);
  return {safety, &kerf_safety_destroy};
}

class KerfSafety : public testing::Test {
 protected:
  std::uint32_t step(double position, double elapsed_s = period_s, double velocity = 0.0) {
    return kerf_step_safely(safety.get(), state.get(), &position, &velocity, elapsed_s, &force);
  }
  /// Until the ramp is over.
  void start_at(double position) {
    for (int tick = 0; tick < 300; ++tick) (void)step(position);
  }

  test::OpenLaw law = test::parsed(test::wall);
  test::OpenState state = test::state_of(law);
  OpenSafety safety = safety_for(law);
  double force = 0.0;
};

TEST_F(KerfSafety, GivesWhatTheLoopsOwnGives) {
  drivers::DeviceInfo device;
  device.axes = {{.name = "position",
                  .position_unit = "m",
                  .force_unit = "N",
                  .resolution = limits.resolution,
                  .force_limit = limits.force,
                  .slew_limit = limits.slew,
                  .speed_limit = limits.speed,
                  .acceleration_limit = limits.acceleration}};
  bench::Safety loops(device, {});
  bench::LawRendering rendering(bench::parse_law_file(std::string(test::wall), "a law").law,
                                {.position = 0.01}, {0});
  std::uint32_t seen = 0;
  int unstepped = 1;
  for (int tick = 0; tick < 5000; ++tick) {
    drivers::Sample sample;
    sample.position[0] = 0.02 + 0.03 * std::sin(0.004 * tick) + 1e-9 * tick;
    sample.velocity[0] = 0.12 * std::cos(0.004 * tick);
    if (tick == 1000) sample.position[0] += 0.5;                 // a bit was turned
    if (tick == 2000) sample.velocity[0] = INFINITY;             // the driver failed
    if (tick > 3000 && tick < 3100) sample.position[0] += 0.03;  // an encoder slipped, and back
    bench::Command command{.flags = loops.judge(drivers::Status::ok, sample, period_s)};
    if (command.flags == 0) {
      command = rendering(sample, unstepped * period_s);
      unstepped = 0;
    }
    ++unstepped;
    loops.apply(command);
    const std::uint32_t flags = step(sample.position[0], period_s, sample.velocity[0]);
    ASSERT_EQ(flags, command.flags) << "tick " << tick;
    ASSERT_EQ(force, command.force[0]) << "tick " << tick;
    seen |= flags;
  }
  EXPECT_EQ(seen, std::uint32_t{KERF_SOFT_START | KERF_SLEW_LIMITED | KERF_FORCE_LIMITED | KERF_DEVICE_FAULT |
                                KERF_POSITION_JUMP | KERF_ZERO_HELD});
}

TEST_F(KerfSafety, LetsTheForceInAlongARamp) {
  EXPECT_EQ(step(0.02), std::uint32_t{KERF_SOFT_START});
  EXPECT_GT(force, -0.01);
  start_at(0.02);
  EXPECT_EQ(step(0.02), 0U);
  EXPECT_DOUBLE_EQ(force, -1.0);
}

TEST_F(KerfSafety, HoldsZeroAfterAJumpUntilSomebodyConfirms) {
  start_at(0.02);
  EXPECT_EQ(step(0.07), std::uint32_t{KERF_POSITION_JUMP});
  EXPECT_EQ(force, 0.0);
  for (int tick = 0; tick < 50; ++tick) (void)step(0.07 + 1e-6 * tick);
  EXPECT_EQ(step(0.0701), std::uint32_t{KERF_ZERO_HELD});
  kerf_safety_confirm(safety.get());
  EXPECT_EQ(step(0.07011) & ~std::uint32_t{KERF_SLEW_LIMITED}, std::uint32_t{KERF_SOFT_START});
}

TEST_F(KerfSafety, LetsGoOfAHostThatStalled) {
  start_at(0.02);
  EXPECT_EQ(step(0.02, 0.5), std::uint32_t{KERF_WATCHDOG});
  EXPECT_EQ(force, 0.0);
  EXPECT_EQ(step(0.02), std::uint32_t{KERF_SOFT_START});
}

TEST_F(KerfSafety, TakesARepeatedPositionForTheSameReport) {
  // A device that reports at 250 Hz and a host at 1 kHz: 4 mm between reports is 1 m/s, and no jump.
  const kerf_safety_options slow{
      .period_s = period_s, .soft_start_s = 0.25, .stall_s = 0.01, .report_s = 4e-3};
  const auto jumps = [&](int tick) {
    const int report = tick / 4;
    return (step(0.004 * report) & (KERF_POSITION_JUMP | KERF_ZERO_HELD)) != 0;
  };
  safety = safety_for(law, &slow);
  for (int tick = 0; tick < 400; ++tick) ASSERT_FALSE(jumps(tick)) << tick;
  // One that stands still reports that all the same: a bit that turns then is a jump.
  for (int tick = 0; tick < 400; ++tick) ASSERT_FALSE(jumps(399));
  EXPECT_TRUE(jumps(420));
  safety = safety_for(law);
  EXPECT_FALSE(jumps(0) || jumps(3));
  EXPECT_TRUE(jumps(4)) << "without being told";
}

TEST_F(KerfSafety, MakesATickThatTookNoTimeZero) {
  start_at(0.02);
  EXPECT_EQ(step(0.02, 0.0), std::uint32_t{KERF_LAW_FAULT});
  EXPECT_EQ(force, 0.0);
  EXPECT_EQ(kerf_safety_judge(safety.get(), &force, nullptr, -1.0), std::uint32_t{KERF_LAW_FAULT});
}

TEST_F(KerfSafety, LimitsTheSumOfSeveralLawsByItsHalves) {
  const OpenSafety halves = safety_for(law);
  for (int tick = 0; tick < 400; ++tick) {
    const double position = 0.02 + 1e-5 * tick;
    const double velocity = 0.01;
    double sum = 0.0;
    std::uint32_t flags = kerf_safety_judge(halves.get(), &position, nullptr, period_s);
    if (flags == 0) flags = kerf_step(test::state_of(law).get(), position, velocity, period_s, &sum);
    flags = kerf_safety_apply(halves.get(), flags, &sum);
    EXPECT_EQ(flags, step(position, period_s, velocity));
    EXPECT_EQ(sum, force);
  }
  double bad = std::nan("");
  EXPECT_EQ(kerf_safety_apply(halves.get(), 0, &bad), std::uint32_t{KERF_LAW_FAULT});
  EXPECT_EQ(bad, 0.0);
}

TEST_F(KerfSafety, BeginsAnewWhereItIsReset) {
  start_at(0.02);
  kerf_safety_reset(safety.get());
  EXPECT_EQ(step(0.07), std::uint32_t{KERF_SOFT_START}) << "no jump from anywhere";
}

TEST_F(KerfSafety, OfOtherAxesGivesZero) {
  const test::OpenState spatial = test::state_of(test::opened(test::example_file("fuzzy_kelvin_3d")));
  const std::array<double, 3> position{0.0, 0.0, -0.004};
  std::array<double, 3> forces{7.0, 7.0, 7.0};
  EXPECT_EQ(kerf_step_safely(safety.get(), spatial.get(), position.data(), nullptr, period_s, forces.data()),
            std::uint32_t{KERF_LAW_FAULT});
  EXPECT_EQ(forces[0], 0.0);
}

TEST_F(KerfSafety, TakesNoMemoryInTheLoop) {
  const test::NoAllocation nothing;
  for (int tick = 0; tick < 50; ++tick) (void)step(tick == 30 ? 0.5 : 0.02, tick == 20 ? 1.0 : period_s);
  kerf_safety_confirm(safety.get());
  kerf_safety_reset(safety.get());
}

TEST_F(KerfSafety, RefusesLimitsThatAreNone) {
  const auto why = [&](kerf_limits wrong, const kerf_safety_options* options = nullptr) {
    kerf_safety* none = nullptr;
    std::array<char, 300> error{};
    EXPECT_EQ(kerf_safety_create(law.get(), &wrong, options, &none, error.data(), error.size()),
              KERF_BAD_INPUT);
    EXPECT_EQ(none, nullptr);
    return std::string(error.data());
  };
  EXPECT_EQ(why({.force = 0.0, .slew = 1.0}),
            "safety: axis 'position': the limit of force is 0, expected a finite number above 0");
  EXPECT_THAT(why({.force = 1.0, .slew = NAN}), testing::HasSubstr("the limit of slew is nan"));
  EXPECT_THAT(why({.force = 1.0, .slew = 1.0, .speed = -1.0}),
              testing::HasSubstr("the limit of speed is -1"));
  const kerf_safety_options timeless{.period_s = 0.0, .soft_start_s = 0.0, .stall_s = 0.01, .report_s = 0.0};
  EXPECT_THAT(why(limits, &timeless), testing::HasSubstr("period 0 s"));
}

}  // namespace
}  // namespace kerf

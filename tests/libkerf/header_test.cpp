#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/kerf.hpp>

#include "libkerf/opened.h"

namespace kerf {
namespace {

TEST(KerfForCpp, StepsAsTheCDoes) {
  const Law law = Law::parse(test::wall, "wall.law.toml");
  State state(law);
  EXPECT_EQ(law.model(), "friction");
  EXPECT_EQ(law.parameter(1).value, 100.0);
  EXPECT_THROW((void)law.parameter(9), Error);
  EXPECT_THROW((void)law.axis(1), Error);
  const Force force = state.step(0.03, 0.0, 1e-3);
  EXPECT_DOUBLE_EQ(force.force, -2.0);
  EXPECT_EQ(force.flags, 0U);
  EXPECT_DOUBLE_EQ(state.step_depth(0.03, 0.0, 1e-3).force, 3.0);
  const std::array position{0.03};
  std::array<double, 1> forces{};
  EXPECT_EQ(state.step(position, {}, 1e-3, forces), 0U);
  EXPECT_DOUBLE_EQ(forces[0], -2.0);
}

TEST(KerfForCpp, ThrowsAtSetUpWithTheLine) {
  try {
    (void)Law::open("/nowhere/x.law.toml");
    FAIL() << "opened";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/x.law.toml: no such file");
    EXPECT_EQ(error.status(), KERF_BAD_INPUT);
  }
  const Law law = Law::parse(test::wall, "wall.law.toml");
  EXPECT_THROW(Safety(law, {}), Error);
  EXPECT_THROW((void)load_plugin("/nowhere/mylaw.so"), Error);
}

TEST(KerfForCpp, TellsTheOptionsOfALaw) {
  const Law law = Law::open(test::example_file("friction"));
  EXPECT_THROW((void)law.option(law.option_count()), Error);
  const Law kelvin = Law::open(test::example_file("kelvin"));
  ASSERT_GT(kelvin.option_count(), 0U);
  EXPECT_STRNE(kelvin.option(0).meaning, "");
}

TEST(KerfForCpp, CopiesAndAssignsStates) {
  const Law law = Law::open(test::example_file("kelvin"));
  State state(law);
  for (int tick = 0; tick < 100; ++tick) (void)state.step(0.5 - 1e-3 * tick, -1.0, 1e-3);
  State copy(state);
  const double next = state.step(0.39, -1.0, 1e-3).force;
  EXPECT_EQ(copy.step(0.39, -1.0, 1e-3).force, next);
  EXPECT_NE(State(law).step(0.39, -1.0, 1e-3).force, next);
  EXPECT_TRUE(copy.assign(state));
  EXPECT_FALSE(copy.assign(State(Law::open(test::example_file("kelvin")))));
}

TEST(KerfForCpp, StepsWithinLimits) {
  const Law law = Law::parse(test::wall, "wall.law.toml");
  State state(law);
  const std::array limits{kerf_limits{.force = 1.0, .slew = 1e4}};
  Safety safety(law, limits);
  const std::array position{0.05};
  std::array<double, 1> force{};
  std::uint32_t flags = 0;
  for (int tick = 0; tick < 500; ++tick) flags = safety.step(state, position, {}, 1e-3, force);
  EXPECT_EQ(flags, std::uint32_t{KERF_FORCE_LIMITED});
  EXPECT_EQ(force[0], -1.0);
}

}  // namespace
}  // namespace kerf

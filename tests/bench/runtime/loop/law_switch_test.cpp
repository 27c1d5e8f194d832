#include "loop/law_switch.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

/// A spring of so many N/rad, at a penetration of 0.1 rad.
LawRendering spring(double stiffness) {
  const std::array values{stiffness, 1e-9, 1e-9};
  return {models::Law::make("kelvin", values), {.position = 0.0, .direction = -1.0}, {0}};
}

double next_force(LawSwitch& laws, std::uint32_t* flags = nullptr) {
  drivers::Sample sample;
  sample.position[0] = -0.1;
  const Command command = laws(sample, 1e-3);
  if (flags != nullptr) *flags = command.flags;
  return command.force[0];
}

void skip(LawSwitch& laws, int ticks) {
  for (int i = 0; i < ticks; ++i) (void)next_force(laws);
}

constexpr double exactly = 1e-9;

TEST(LawSwitch, GoesOverLinearlyAtItsTime) {
  LawSwitch laws({{.rendering = spring(10.0)}, {.rendering = spring(30.0), .from_s = 0.1}}, 0.25);
  skip(laws, 100);  // ticks 0 to 99
  std::uint32_t flags = 0;
  EXPECT_NEAR(next_force(laws, &flags), 1.0, exactly) << "at 0.1 s it begins";
  EXPECT_EQ(flags, schema::flag_soft_switch);
  skip(laws, 124);
  EXPECT_NEAR(next_force(laws), 2.0, exactly) << "half way after half of it";
  skip(laws, 124);
  EXPECT_NEAR(next_force(laws, &flags), 3.0, exactly);
  EXPECT_NEAR(next_force(laws, &flags), 3.0, exactly);
  EXPECT_EQ(flags, 0U);
}

TEST(LawSwitch, GoesOverWhenAskedAndBackAgain) {
  LawSwitch laws({{.rendering = spring(10.0)}, {.rendering = spring(30.0)}}, 0.01);
  EXPECT_NEAR(next_force(laws), 1.0, exactly);
  laws.select(1);
  skip(laws, 11);
  EXPECT_NEAR(next_force(laws), 3.0, exactly);
  laws.select(0);
  skip(laws, 11);
  EXPECT_NEAR(next_force(laws), 1.0, exactly);
}

TEST(LawSwitch, FinishesOneSwitchBeforeTheNext) {
  LawSwitch laws({{.rendering = spring(10.0)}, {.rendering = spring(30.0)}, {.rendering = spring(50.0)}},
                 0.01);
  double last = next_force(laws);
  laws.select(1);
  for (int i = 0; i < 30; ++i) {
    if (i == 4) laws.select(2);
    const double force = next_force(laws);
    EXPECT_LE(std::abs(force - last), 0.2 + exactly) << "2 N in 10 ticks is the steepest";
    last = force;
  }
  EXPECT_NEAR(last, 5.0, exactly);
}

TEST(LawSwitch, TakesTheLastLawForOneThatDoesNotExist) {
  LawSwitch laws({{.rendering = spring(10.0)}, {.rendering = spring(30.0)}}, 0.0);
  laws.select(7);
  EXPECT_NEAR(next_force(laws), 3.0, exactly);
}

TEST(LawSwitch, IsAFaultWhileEitherLawFaults) {
  LawSwitch laws({{.rendering = spring(10.0)}, {.rendering = spring(30.0)}}, 0.01);
  laws.select(1);
  drivers::Sample sample;
  sample.position[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(laws(sample, 1e-3).flags & schema::flag_law_fault, 0U);
}

}  // namespace
}  // namespace kerf::bench

#include "plot/colour_steps.h"

#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

/// Luma of "#rrggbb", which is what is left of it in grey.
double grey_of(const std::string& colour) {
  const auto channel = [&](std::size_t at) { return std::stoi(colour.substr(at, 2), nullptr, 16); };
  return 0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5);
}

TEST(ColourSteps, AreRoundAndHoldBothEnds) {
  const ColourSteps linear = round_steps("x", 0.3, 9.2);
  EXPECT_THAT(linear.bounds,
              Pointwise(DoubleNear(1e-9), {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0}));
  const ColourSteps wide = round_steps("x", 0.02, 3.0);
  EXPECT_THAT(wide.bounds, Pointwise(DoubleNear(1e-9), {0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0}));
  EXPECT_THAT(round_steps("x", 4.0, 4.0).bounds, ElementsAre(2.0, 6.0));
  EXPECT_THAT(round_steps("x", 0.0, 0.0).bounds, ElementsAre(-1.0, 1.0));
}

TEST(ColourSteps, TakeANumberAtABoundForTheStepAbove) {
  const ColourSteps steps{.label = "x", .bounds = {0.0, 1.0, 2.0}};
  EXPECT_EQ(steps.step_of(0.0), 0U);
  EXPECT_EQ(steps.step_of(1.0), 1U);
  EXPECT_EQ(steps.step_of(2.0), 1U);
  EXPECT_EQ(steps.step_of(-7.0), 0U);
}

TEST(ColourSteps, GetLighterAllTheWay) {
  const ColourSteps steps = share_steps("x");
  for (std::size_t i = 1; i < steps.steps(); ++i)
    EXPECT_GT(grey_of(steps.colour_of_step(i)), grey_of(steps.colour_of_step(i - 1)) + 5.0) << i;
  EXPECT_EQ(steps.ink_on_step(0), "#ffffff");
  EXPECT_EQ(steps.ink_on_step(steps.steps() - 1), "#000000");
}

}  // namespace
}  // namespace kerf::bench

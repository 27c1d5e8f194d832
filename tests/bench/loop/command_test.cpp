#include "loop/command.h"

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(LawRendering, PushesAgainstTheEngagement) {
  const double values[] = {10.0, 1e-9, 1e-9};
  const models::Law spring = models::Law::make("kelvin", values);
  LawRendering closing(spring, {.position = 0.5, .direction = -1.0}, 0);
  LawRendering pressing(spring, {.position = 0.01, .direction = 1.0}, 1);
  drivers::Sample sample;
  sample.position = {0.3, 0.03};
  EXPECT_NEAR(closing(sample, 1e-3).force[0], 10.0 * 0.2, 1e-9) << "blades that close are pushed open";
  EXPECT_NEAR(pressing(sample, 1e-3).force[1], -10.0 * 0.02, 1e-9);
  sample.position = {0.7, 0.0};
  EXPECT_EQ(closing(sample, 1e-3).force[0], 0.0) << "no force before contact";
}

}  // namespace
}  // namespace kerf::bench

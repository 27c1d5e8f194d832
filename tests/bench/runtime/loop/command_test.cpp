#include "loop/command.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(LawRendering, PushesAgainstTheEngagement) {
  const double values[] = {10.0, 1e-9, 1e-9};
  const models::Law spring = models::Law::make("kelvin", values);
  LawRendering closing(spring, {.position = 0.5, .direction = -1.0}, {0});
  LawRendering pressing(spring, {.position = 0.01, .direction = 1.0}, {1});
  drivers::Sample sample;
  sample.position = {0.3, 0.03};
  EXPECT_NEAR(closing(sample, 1e-3).force[0], 10.0 * 0.2, 1e-9) << "blades that close are pushed open";
  EXPECT_NEAR(pressing(sample, 1e-3).force[1], -10.0 * 0.02, 1e-9);
  sample.position = {0.7, 0.0};
  EXPECT_EQ(closing(sample, 1e-3).force[0], 0.0) << "no force before contact";
}

TEST(LawRendering, GivesASpatialLawTheAxesThatItNames) {
  // Friction of a vertical blade in a tissue under z = 0, on a device that has its axes in another order.
  const double values[] = {0.0, 2e4, 4e3};
  const models::Law blade =
      models::Law::make("blade", values, {{"thresholds", false}, {"edge", std::string()}});
  LawRendering rendering(blade, {}, {2, 1, 0, 3, 4, 5});
  drivers::Sample sample;
  sample.position = {0.10, 0.0, 0.0, 0.0, 0.0, 0.0};
  sample.velocity = {0.0, 0.02, 0.05, 0.0, 0.0, 0.0};
  const Command command = rendering(sample, 1e-3);
  EXPECT_NEAR(command.force[2], -0.024, 1e-12) << "x of the law";
  EXPECT_NEAR(command.force[1], -0.048, 1e-12);
  EXPECT_NEAR(command.force[3], -5.088e-3, 1e-12);
  EXPECT_EQ(command.flags, 0U);
  sample.position[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rendering(sample, 1e-3).flags, schema::flag_law_fault);
}

}  // namespace
}  // namespace kerf::bench

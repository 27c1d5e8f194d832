#include "stability/wall/wall_simulation.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

struct NamedDevice {
  std::string name;
  SampledDevice device;
};

class LinearWall : public testing::TestWithParam<NamedDevice> {};

TEST_P(LinearWall, BreaksWhereItsEigenvaluesSay) {
  const SampledDevice& device = GetParam().device;
  int compared = 0;
  for (const double damping : {0.0, 0.1, 0.5, 2.0, 8.0}) {
    const double theory = eigenvalue_boundary(device, damping, 1.0, 1e6);
    if (theory == 1.0) continue;  // no stiffness is stable
    EXPECT_NEAR(WallSimulation(device).boundary(damping, 1.0, 1e6, {}), theory, 0.01 * theory) << damping;
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

constexpr SampledDevice handle{.mass_kg = 0.1, .viscous_n_s_per_m = 0.4};
SampledDevice with(double delay_s, double corner, HandImpedance hand, double period_s = 1e-3) {
  SampledDevice device = handle;
  device.delay_s = delay_s;
  device.velocity_corner_rad_s = corner;
  device.hand = hand;
  device.period_s = period_s;
  return device;
}
INSTANTIATE_TEST_SUITE_P(Devices, LinearWall,
                         testing::Values(NamedDevice{"Plain", handle},
                                         NamedDevice{"HalfATickLate", with(0.5e-3, 0.0, {})},
                                         NamedDevice{"ThreeTicksLate", with(3e-3, 0.0, {})},
                                         NamedDevice{"Filtered", with(0.0, 125.0, {})},
                                         NamedDevice{"InAHand", with(1.3e-3, 200.0, {0.15, 5.0, 500.0})},
                                         NamedDevice{"At250Hz", with(0.0, 0.0, {}, 4e-3)}),
                         [](const auto& about) { return about.param.name; });

TEST(Wall, WithoutAnyFrictionNeverComesToRest) {
  const SampledDevice free{.mass_kg = 0.1, .viscous_n_s_per_m = 0.0};
  EXPECT_FALSE(WallSimulation(free).comes_to_rest({.stiffness_n_per_m = 100.0}, {}));
}

TEST(Wall, ComesToRestByCoulombFrictionWhereViscousFrictionAloneWouldNotDo) {
  SampledDevice device{.mass_kg = 0.05, .viscous_n_s_per_m = 0.1};
  const Wall stiff{.stiffness_n_per_m = 400.0};  // 2 b / T = 200
  EXPECT_FALSE(WallSimulation(device).comes_to_rest(stiff, {}));
  device.coulomb_n = 0.1;
  EXPECT_TRUE(WallSimulation(device).comes_to_rest(stiff, {.start_m = 1e-4}));
}

TEST(Wall, KeepsALimitCycleThatAnEncoderFeeds) {
  // One step of the encoder is read as 36 mm/s, against which the wall pushes with 1.1 N.
  SampledDevice device{.mass_kg = 0.05, .viscous_n_s_per_m = 0.2, .encoder_step_m = 3.6e-5};
  const Wall wall{.stiffness_n_per_m = 200.0, .damping_n_s_per_m = 30.0};
  EXPECT_FALSE(WallSimulation(device).comes_to_rest(wall, {.start_m = 5e-3, .push_n = 2.0}));
  device.encoder_step_m = 1e-6;
  EXPECT_TRUE(WallSimulation(device).comes_to_rest(wall, {.start_m = 5e-3, .push_n = 2.0}));
}

}  // namespace
}  // namespace kerf::bench

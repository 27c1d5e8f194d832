#include "stability/wall/wall_simulation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "stability/bisection.h"
#include "stability/wall/wall_force.h"

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

/// Whether a wall comes to rest by a loop of its own, tick by tick.
bool alone(const SampledDevice& device, const Wall& wall, double seconds) {
  SampledLoop loop(device, WallForce{.wall = wall, .one_sided = false}, {.position_m = 1e-3});
  const int quarter = static_cast<int>(0.25 * seconds / device.period_s);
  const double stiffness = wall.stiffness_n_per_m + device.hand.stiffness_n_per_m;
  double energy[4] = {};
  for (double& of_quarter : energy) {
    double sum = 0.0, squares = 0.0, speeds = 0.0;
    for (int tick = 0; tick < quarter; ++tick) {
      loop.step();
      const auto [x, v] = loop.motion();
      if (!(std::abs(x) < 1.0)) return false;
      sum += x;
      squares += x * x;
      speeds += v * v;
    }
    of_quarter = device.moving_mass_kg() * speeds / quarter +
                 stiffness * (squares / quarter - sum * sum / (1.0 * quarter * quarter));
  }
  return energy[3] < energy[1] || energy[3] < stiffness * 1e-24;
}

TEST_P(LinearWall, ComesToRestAmongManyAsItDoesAlone) {
  const SampledDevice& device = GetParam().device;
  std::vector<Wall> walls;
  for (int i = 0; i < 37; ++i)  // two packets and a part of one
    walls.push_back({20.0 * std::pow(1.25, i), 0.07 * (i % 9) * (i % 9)});
  const std::vector<bool> together = WallSimulation(device).come_to_rest(walls, {.seconds = 1.0});
  int rest = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    EXPECT_EQ(together[i], alone(device, walls[i], 1.0)) << i;
    EXPECT_EQ(together[i], WallSimulation(device).comes_to_rest(walls[i], {.seconds = 1.0})) << i;
    rest += together[i] ? 1 : 0;
  }
  EXPECT_GT(rest, 2);
  EXPECT_LT(rest, 35);
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

TEST(FirstChange, IsFoundByManyQuestionsAtOnceAsByOneAfterAnother) {
  const Search search{.lower = 1.0, .upper = 1000.0, .share = 1e-3};
  for (const double change : {0.5, 1.5, 37.0, 999.0, 2000.0}) {
    const auto holds = [&](double number) { return number < change; };
    const double truth = std::clamp(change, search.lower, search.upper);
    EXPECT_NEAR(first_change(search, holds), truth, 1e-3 * truth);
    for (const std::size_t many : {std::size_t{2}, std::size_t{5}, std::size_t{16}}) {
      const auto hold = [&](std::span<const double> numbers) {
        EXPECT_LE(numbers.size(), many);
        std::vector<bool> all;
        for (const double number : numbers) all.push_back(holds(number));
        return all;
      };
      EXPECT_NEAR(first_change_of_many(search, many, hold), truth, 1e-3 * truth) << many;
    }
  }
}

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

// Nothing takes energy out of a bounce on a one-sided wall but what the eigenvalues know: it goes on for ever
// beyond their boundary, and whatever its energy does from one quarter of a trial to another is chance.
TEST(Wall, ThatBouncesForEverDoesNotComeToRestByChance) {
  const SampledDevice device{.mass_kg = 0.1, .viscous_n_s_per_m = 0.5};
  const WallSimulation walls(device);
  for (const double damping : {0.0, 5.0, 20.0, 69.26}) {
    const double theory = eigenvalue_boundary(device, damping, 1.0, 1e6);
    for (const double seconds : {2.0, 5.0}) {
      const double found = walls.boundary(damping, 1.0, 1e6, {.seconds = seconds, .push_n = 2.0});
      EXPECT_LE(found, 1.02 * theory) << damping << " N·s/m, " << seconds << " s";
    }
  }
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

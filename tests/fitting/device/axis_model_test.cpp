#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/identification/axis_model.h>

namespace kerf::identification {
namespace {

TEST(AxisModel, MovesAsScipysExponentialDoesUnderADelayOfAFractionOfATick) {
  // scipy.linalg.expm, piece by piece of 0.37 and 0.63 ms.
  const AxisModel axis{.mass_kg = 0.1,
                       .viscous_n_s_per_m = 0.5,
                       .coulomb_n = 0.0,
                       .stiffness_n_per_m = 20.0,
                       .offset_n = 0.03,
                       .delay_s = 1.37e-3};
  const std::vector<double> commanded{1.0, -2.0, 0.5, 3.0, 0.0, -1.0, 2.0, 0.25, 0.0};
  const std::array expected{0.002,
                            0.00198997537494422,
                            0.00198188540385255,
                            0.00197708580299206,
                            0.0019592657381447,
                            0.00194968261685357,
                            0.00196233123099095,
                            0.00197488663522269,
                            0.0019839385241457};
  std::array<double, 9> position{};
  simulate(axis, 1e-3, {.position_m = 0.002, .speed_m_s = -0.01}, commanded, 0, position);
  for (std::size_t n = 0; n < expected.size(); ++n) EXPECT_NEAR(position[n], expected[n], 1e-16) << n;
}

TEST(AxisModel, ComesToRestWhereCoulombFrictionHasTakenItsEnergy) {
  // m v^2 / 2 = f x; it then sticks.
  const AxisModel axis{.mass_kg = 0.2, .coulomb_n = 0.3};
  const std::vector<double> nothing(200, 0.0);
  std::vector<double> position(200);
  std::vector<TickFriction> friction(200);
  simulate(axis, 1e-3, {.position_m = 0.0, .speed_m_s = 0.15}, nothing, 0, position, friction);
  EXPECT_NEAR(position.back(), 0.2 * 0.15 * 0.15 / 2.0 / 0.3, 1e-12);
  EXPECT_EQ(position[150], position.back());
  EXPECT_NEAR(friction.front().mean_n, -0.3, 1e-12);
  EXPECT_NEAR(friction.back().mean_n, 0.0, 1e-12);
}

TEST(AxisModel, FrictionsMeanAndMomentMoveAMassFromTickToTick) {
  // Without damping and spring: m x_1 = m (x_0 + v_0 T) + (u + F) T^2 / 2 - M T and m v_1 = m v_0 + (u + F)
  // T, also where it turns round or stops within a tick.
  constexpr double m = 0.1;
  constexpr double period_s = 1e-3;
  const AxisModel axis{.mass_kg = m, .coulomb_n = 0.2};
  std::vector<double> commanded(400);
  for (std::size_t n = 0; n < commanded.size(); ++n) {
    commanded[n] = 0.6 * std::sin(0.083 * static_cast<double>(n)) + 0.1 * static_cast<double>(n % 3);
  }
  std::vector<double> position(400);
  std::vector<TickFriction> friction(400);
  simulate(axis, period_s, {}, commanded, 0, position, friction);
  double x = 0.0;
  double v = 0.0;
  std::size_t turns = 0;
  for (std::size_t n = 0; n + 1 < position.size(); ++n) {
    const auto& [mean, moment] = friction[n];
    turns += std::abs(moment) > 1e-9 ? 1U : 0U;
    x += v * period_s + ((commanded[n] + mean) * period_s / 2.0 - moment) * period_s / m;
    v += (commanded[n] + mean) * period_s / m;
    ASSERT_NEAR(x, position[n + 1], 1e-13) << n;
  }
  EXPECT_GT(turns, 5U);
}

TEST(AxisModel, FrictionByDirectionAndAConstantForceMoveItInTheSameWay) {
  // f+ = 0.3 and f- = 0.1 without gravity: what f = 0.2 and o = -0.1 do. It slides from u - 0.3 > 0 on.
  const AxisModel axis{.mass_kg = 0.1, .coulomb_n = 0.2, .offset_n = -0.1};
  std::vector<double> position(101);
  const auto end_under = [&](double force) {
    const std::vector<double> commanded(101, force);
    simulate(axis, 1e-3, {}, commanded, 0, position);
    return position.back();
  };
  EXPECT_EQ(end_under(0.29), 0.0);
  EXPECT_NEAR(end_under(0.35), 0.05 / 0.1 * 0.1 * 0.1 / 2.0, 1e-12);
  EXPECT_EQ(end_under(-0.09), 0.0);
  EXPECT_NEAR(end_under(-0.15), -0.05 / 0.1 * 0.1 * 0.1 / 2.0, 1e-12);
}

}  // namespace
}  // namespace kerf::identification

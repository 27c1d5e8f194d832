#include "stability/controllers/wall_controller.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/drivers/gaussian.h>

#include "stability/controllers/controlled_theory.h"
#include "stability/controllers/controller_design.h"
#include "support/allocation_counter.h"

namespace kerf::bench {
namespace {

/// That of the NumPy numbers below.
SampledDevice held_device(double delay_periods) {
  return {.mass_kg = 0.08,
          .viscous_n_s_per_m = 0.5,
          .delay_s = 1e-3 * delay_periods,
          .velocity_corner_rad_s = 400.0,
          .hand = {.mass_kg = 0.1, .damping_n_s_per_m = 2.0, .stiffness_n_per_m = 200.0}};
}

ControllerDesign given(WallController controller, const SampledDevice& device) {
  return {.controller = controller,
          .device = device,
          .most_damping_n_s_per_m = 2.0,
          .coupling_stiffness_n_per_m = 700.0,
          .coupling_damping_n_s_per_m = 0.1};
}

// NumPy and SciPy: matrix exponentials of mass, damper and spring of device and hand by scipy.linalg.expm,
// the controllers as transfer functions (none, damping, coupling: K_c T / (1 - z^-1) + B_c G in series with
// the wall) or as the powers of the predictor's matrix (exact); the largest of numpy.linalg.eigvals of the
// closed system of K = 3000 N/m, B = 1 N·s/m.
TEST(Controllers, HaveTheEigenvaluesOfTheirEquations) {
  struct Stored {
    WallController controller;
    double delay_periods;
    double radius;
  };
  for (const Stored& one : {Stored{WallController::none, 0.0, 0.994742726489},
                            Stored{WallController::damping, 0.0, 0.992202056859},
                            Stored{WallController::damping, 1.6, 1.00601762233},
                            Stored{WallController::coupling, 0.0, 0.993583305404},
                            Stored{WallController::coupling, 1.6, 0.996112193506},
                            Stored{WallController::exact, 0.0, 0.99072316109},
                            Stored{WallController::exact, 2.0, 0.991660660461}}) {
    const SampledDevice device = held_device(one.delay_periods);
    const ControlledSystem system(given(one.controller, device), device,
                                  {.stiffness_n_per_m = 3000.0, .damping_n_s_per_m = 1.0});
    EXPECT_NEAR(system.spectral_radius(), one.radius, 1e-9) << name_of(one.controller);
  }
}

TEST(Controllers, GiveTheImpedanceOfTheExactlySampledLoop) {
  // From the same: H(z) exp(-j w t_d) (1 - exp(-j w T)) / (j w T) / (j w) at 1, 10, 30 Hz; K = 1000 N/m,
  // B = 1 N·s/m (damping: 2 N·s/m).
  struct Stored {
    WallController controller = WallController::none;
    double delay_periods = 0.0;
    std::array<std::complex<double>, 3> impedance;
  };
  const std::array<Stored, 6> all{
      {{WallController::none,
        2.0,
        {{{-1.50051800504, -159.16666107},
          {-1.55019132127, -16.0229519741},
          {-1.8562085794, -5.43740345744}}}},
       {WallController::damping,
        0.0,
        {{{1.499388516, -159.1920031}, {1.440317093, -16.27676901}, {1.050086563, -6.203967057}}}},
       {WallController::damping,
        2.0,
        {{{-0.5011429294, -159.1982754}, {-0.6110603287, -16.32894142}, {-1.307486804, -6.154865335}}}},
       {WallController::coupling,
        2.0,
        {{{-0.8252778276, -65.53094571}, {-0.8270310448, -6.518550441}, {-0.8374053221, -2.069977185}}}},
       {WallController::exact,
        0.0,
        {{{0.4189157451, -159.0486403}, {0.8638296715, -15.76544856}, {0.9370410466, -5.453681473}}}},
       {WallController::exact,
        2.0,
        {{{-1.935341323, -158.5522921}, {0.4222998482, -15.16667165}, {0.5447438541, -6.008404506}}}}}};
  for (const Stored& one : all) {
    const SampledDevice device = held_device(one.delay_periods);
    const ControlledSystem system(given(one.controller, device), device,
                                  {.stiffness_n_per_m = 1000.0, .damping_n_s_per_m = 1.0});
    constexpr std::array frequencies{1.0, 10.0, 30.0};
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      EXPECT_LT(std::abs(system.loop_impedance(frequencies[i]) - one.impedance[i]),
                1e-6 * std::abs(one.impedance[i]))
          << name_of(one.controller) << " at " << frequencies[i];
    }
  }
}

TEST(Controllers, WithoutOneAWallIsTheWallThatWasStudied) {
  for (const double delay_periods : {0.0, 1.6}) {
    const SampledDevice device = held_device(delay_periods);
    const ControllerDesign none{.device = device};
    const double truth = eigenvalue_boundary(device, 3.0, 50.0, 20'000.0);
    EXPECT_NEAR(controlled_boundary(none, device, 3.0, 50.0, 20'000.0), truth, 1e-5 * truth);
    const double passive = passive_stiffness(device, 0.3);
    EXPECT_NEAR(controlled_passive(none, 0.3, 20'000.0), passive, 0.01 * passive + 1.0);
  }
}

TEST(Controllers, StepWithoutAllocating) {
  const SampledDevice device = held_device(1.6);
  for (const WallController controller : wall_controllers) {
    ControlledWall wall(given(controller, device));
    const test::NoAllocation none;
    wall.begin({.stiffness_n_per_m = 1000.0, .damping_n_s_per_m = 1.0});
    double sum = 0.0;
    for (int tick = 0; tick < 100; ++tick)
      sum += wall.step({.position_m = 1e-3 * std::sin(0.1 * tick), .speed_m_s = 0.0});
    EXPECT_TRUE(std::isfinite(sum));
  }
}

TEST(ExplicitDamping, IsTheLargestDamperThatIsPassiveByItself) {
  SampledDevice device = held_device(0.0);
  device.velocity_corner_rad_s = 0.0;
  // Plain difference: b > K T / 2 + |B| [ColgateSchenkel1997].
  EXPECT_NEAR(design_controller(WallController::damping, device).most_damping_n_s_per_m, 0.5, 1e-6);
  device.velocity_corner_rad_s = 126.0;
  EXPECT_GT(design_controller(WallController::damping, device).most_damping_n_s_per_m, 0.5)
      << "behind a filter a damper does less, and needs less";
}

TEST(VirtualCoupling, IsBoundByColgateAndSchenkelBeforeAClampedWall) {
  SampledDevice device = held_device(0.0);
  device.velocity_corner_rad_s = 0.0;
  for (const double damping : {0.0, 0.1, 0.4}) {
    const double most = 2.0 * (0.5 - damping) / device.period_s;
    EXPECT_TRUE(couples_any(device, 0.999 * most, damping));
    EXPECT_FALSE(couples_any(device, 1.001 * most, damping));
  }
  const ControllerDesign design = design_controller(WallController::coupling, device);
  EXPECT_NEAR(design.coupling_stiffness_n_per_m, friction_used * 1000.0, 1.0);
  EXPECT_NEAR(design.coupling_damping_n_s_per_m, 0.0, 1e-3);
}

TEST(VirtualCoupling, IsStableInEveryHandBeforeEveryWall) {
  drivers::Gaussian normal(5);
  const auto draw = [&](double middle) { return middle * std::exp(1.5 * normal()); };
  for (const double delay_periods : {0.0, 0.7, 2.0}) {
    for (const double corner : {0.0, 126.0}) {
      SampledDevice device = held_device(delay_periods);
      device.velocity_corner_rad_s = corner;
      const ControllerDesign design = design_controller(WallController::coupling, device);
      EXPECT_GT(design.coupling_stiffness_n_per_m, 0.0);
      for (int hand = 0; hand < 25; ++hand) {
        device.hand = {
            .mass_kg = draw(0.1), .damping_n_s_per_m = draw(2.0), .stiffness_n_per_m = draw(200.0)};
        if (hand == 0) device.hand = {};
        const Wall wall{.stiffness_n_per_m = hand % 3 == 0 ? 1e7 : draw(2000.0),
                        .damping_n_s_per_m = hand % 2 == 0 ? 0.0 : draw(3.0)};
        EXPECT_LT(ControlledSystem(design, device, wall).spectral_radius(), 1.0)
            << delay_periods << " periods, hand " << hand;
      }
      // Not so one that is stiffer than the condition allows: somebody's hand finds it.
      ControllerDesign stiffer = design;
      stiffer.coupling_stiffness_n_per_m *= 1.5;
      device.hand = {.mass_kg = 5.0, .damping_n_s_per_m = 0.0, .stiffness_n_per_m = 0.0};
      if (delay_periods == 0.0 && corner == 0.0) {
        EXPECT_GT(ControlledSystem(stiffer, device, {.stiffness_n_per_m = 1e7}).spectral_radius(), 1.0);
      }
    }
  }
}

TEST(VirtualCoupling, RendersBothSpringsInSeries) {
  const SampledDevice device = held_device(0.0);
  ControlledWall wall(given(WallController::coupling, device));
  wall.begin({.stiffness_n_per_m = 300.0});
  double force_n = 0.0;
  for (int tick = 0; tick < 2000; ++tick) force_n = wall.step({.position_m = 1e-3, .speed_m_s = 0.0});
  EXPECT_NEAR(force_n, -1e-3 * 300.0 * 700.0 / 1000.0, 1e-9);
}

/// The most energy of a mass in its wall since it began, over that of the begin; without a hand.
double energy_grows_to(WallController controller, double stiffness) {
  SampledDevice device{.mass_kg = 0.05, .viscous_n_s_per_m = 0.2};
  struct Force {
    ControlledWall wall;
    double operator()(const AxisReading& reading) noexcept { return wall.step(reading); }
  };
  ControlledWall wall({.controller = controller, .device = device});
  wall.begin({.stiffness_n_per_m = stiffness});
  constexpr double start_m = 3e-3;
  SampledLoop<Force> loop(device, {wall}, {.position_m = start_m});
  const auto energy = [&] {
    const auto& [x, v] = loop.motion();
    return 0.5 * (device.mass_kg * v * v + stiffness * x * x);
  };
  double most = 0.0;
  for (int tick = 0; tick < 1000; ++tick) {
    loop.step();
    most = std::max(most, energy());
  }
  return most / (0.5 * stiffness * start_m * start_m);
}

TEST(PassivityControl, CreatesNoEnergy) {
  // Four times 2 b / T. A debt is paid in the tick after it, so that the energy may be up by what one tick
  // leaks, (K T / 2 - b) v^2 T, at the most with v^2 = K x^2 / m.
  constexpr double stiffness = 1600.0;
  constexpr double of_one_tick = 2.0 * (0.5 * stiffness * 1e-3 - 0.2) * 1e-3 / 0.05;
  EXPECT_GT(energy_grows_to(WallController::none, stiffness), 10.0);
  EXPECT_LT(energy_grows_to(WallController::passivity, stiffness), 1.0 + 1.01 * of_one_tick);
}

TEST(ExactWall, LeaksAFractionOfWhatAHeldWallDoes) {
  // Without friction a held wall makes energy as if it had a damping of -K T / 2.
  const SampledDevice device{.mass_kg = 0.05, .viscous_n_s_per_m = 0.0};
  const Wall wall{.stiffness_n_per_m = 2000.0};
  const auto growth = [&](WallController controller) {
    return ControlledSystem({.controller = controller, .device = device}, device, wall).spectral_radius() -
           1.0;
  };
  const double held = growth(WallController::none);
  EXPECT_NEAR(held, 2000.0 * 1e-6 / (4.0 * 0.05), 0.02 * held) << "K T^2 / (4 m) a tick";
  EXPECT_LT(growth(WallController::exact), 0.05 * held);
}

TEST(ExactWall, IsAsStiffAsItsSpringUnderAHandThatLeans) {
  ControlledWall wall({.controller = WallController::exact, .device = held_device(2.0)});
  wall.begin({.stiffness_n_per_m = 5000.0});
  double force_n = 0.0;
  for (int tick = 0; tick < 1000; ++tick) force_n = wall.step({.position_m = 1e-3, .speed_m_s = 0.0});
  EXPECT_NEAR(force_n, -5.0, 1e-6);
}

TEST(Controllers, RefuseWhatTheyCannotBeMadeFor) {
  SampledDevice device = held_device(0.0);
  device.viscous_n_s_per_m = 0.0;
  EXPECT_THROW((void)design_controller(WallController::coupling, device), std::invalid_argument);
  EXPECT_THROW(ControlledSystem(given(WallController::passivity, device), device, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/exponential.h>

namespace kerf::models {
namespace {

// Porcine intestine in vivo [Sepulveda2008].
constexpr Exponential<double> intestine{
    .amplitude = 4.3e-7, .exponent = 13.0, .viscosity = 20.0, .thickness = 0.1, .zero_at_contact = false};

double still(const Exponential<double>& law, double penetration) {
  Exponential<double>::State state;
  return law.step(state, {.penetration = penetration, .velocity = 0.0}, 1e-3);
}

TEST(Exponential, MeetsTheCheckValuesOfPorcineIntestine) {
  EXPECT_NEAR(still(intestine, 0.1) / 0.190237758564, 1.0, 1e-10);
  const double two_newtons_m = 0.118097136991;
  EXPECT_NEAR(still(intestine, two_newtons_m) / 2.0, 1.0, 1e-10);
  EXPECT_NEAR(intestine.stiffness(two_newtons_m) / 260.0, 1.0, 1e-10);
  EXPECT_NEAR(intestine.stored_energy(two_newtons_m) / 0.0153846120769, 1.0, 1e-10);
}

TEST(Exponential, GivesNothingOutsideTheTissue) {
  EXPECT_EQ(still(intestine, 0.0), 0.0);
  EXPECT_EQ(still(intestine, -0.05), 0.0);
}

TEST(Exponential, AddsTheViscousForceInContactOnly) {
  Exponential<double>::State state;
  const double moving = intestine.step(state, {.penetration = 0.1, .velocity = 0.01}, 1e-3);
  EXPECT_NEAR(moving - still(intestine, 0.1), 0.2, 1e-15);
  EXPECT_EQ(intestine.step(state, {.penetration = -0.1, .velocity = 0.01}, 1e-3), 0.0);
}

TEST(Exponential, MayBeginAtZero) {
  Exponential<double> law = intestine;
  law.zero_at_contact = true;
  EXPECT_NEAR(still(law, 1e-9), 0.0, 1e-12);
  EXPECT_NEAR(still(law, 0.1), still(intestine, 0.1) - 4.3e-7, 1e-16);
  EXPECT_NEAR(law.stored_energy(0.1), intestine.stored_energy(0.1) - 4.3e-7 * 0.1, 1e-16);
}

TEST(Exponential, WithAnOffsetIsShiftedInContactAndBefore) {
  const auto law = Exponential<double>::make(std::vector{4.3e-7, 13.0, 20.0, -0.3}, {{"offset", true}});
  EXPECT_NEAR(still(law, 0.1), 0.190237758564 - 0.3, 1e-12);
  EXPECT_EQ(still(law, -0.05), -0.3);
  EXPECT_EQ(law.stored_energy(0.1), intestine.stored_energy(0.1)) << "the tissue's energy, not the sensor's";
}

TEST(Exponential, WithoutViscosityHasOneParameterLess) {
  const Options options{{"viscous", false}, {"offset", true}};
  const auto parameters = Exponential<double>::parameters(options);
  ASSERT_EQ(parameters.size(), 3u);
  EXPECT_EQ(parameters[2].name, "offset");
  const auto law = Exponential<double>::make(std::vector{4.3e-7, 13.0, -0.3}, options);
  Exponential<double>::State state;
  EXPECT_EQ(law.step(state, {.penetration = 0.1, .velocity = 5.0}, 1e-3), still(law, 0.1));
  EXPECT_EQ(law.offset, -0.3);
  EXPECT_EQ(Exponential<double>::parameters({{"viscous", false}}).size(), 2u);
}

TEST(Exponential, StiffnessIsTheSlopeOfTheForce) {
  const double step = 1e-6;
  const double slope = (still(intestine, 0.11 + step) - still(intestine, 0.11 - step)) / (2.0 * step);
  EXPECT_NEAR(intestine.stiffness(0.11) / slope, 1.0, 1e-8);
}

TEST(Exponential, SaysHowDeepAStiffnessLies) {
  const Exponential<double> in_vivo{4.3e-7, 13.0, 20.0, 0.1, false};
  EXPECT_NEAR(in_vivo.depth_at_stiffness(260.0) / 0.118097136991, 1.0, 1e-10) << "by the closed form";
  EXPECT_NEAR(in_vivo.stiffness(in_vivo.depth_at_stiffness(1e3)), 1e3, 1e-9);
  EXPECT_EQ(in_vivo.depth_at_stiffness(1e-9), 0.0) << "softer than at contact";
}

}  // namespace
}  // namespace kerf::models

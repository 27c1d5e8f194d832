#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/precontact.h>

namespace kerf::models {
namespace {

constexpr double K = 250.0;
constexpr double w = 4e-3;
const Precontact<double> smooth{K, w, false};
const Precontact<double> paper{K, w, true};

double force(const Precontact<double>& law, double x) {
  Precontact<double>::State state;
  return law.step(state, {x, 0.0}, 1e-3);
}
double slope(const Precontact<double>& law, double x, double h) {
  return (force(law, x + h) - force(law, x - h)) / (2.0 * h);
}

TEST(Precontact, BeginsAtTheThresholdAndNotBefore) {
  for (const auto* law : {&smooth, &paper}) {
    EXPECT_EQ(force(*law, -w), 0.0);
    EXPECT_EQ(force(*law, -1.0), 0.0);
    EXPECT_GT(force(*law, -0.99 * w), 0.0);
  }
}

TEST(Precontact, MeetsTheClosedFormOfBothForms) {
  EXPECT_NEAR(force(paper, -w / 2.0), K * w / 4.0, 1e-15);
  EXPECT_NEAR(force(paper, 0.0), K * w, 1e-15);
  EXPECT_NEAR(force(paper, 3e-3), K * (3e-3 + w), 1e-15);
  EXPECT_NEAR(force(smooth, -w / 2.0), K * w / 8.0, 1e-15);
  EXPECT_NEAR(force(smooth, 0.0), K * w / 2.0, 1e-15);
  EXPECT_NEAR(force(smooth, 3e-3), K * (3e-3 + w / 2.0), 1e-15);
}

TEST(Precontact, TheSmoothFormHasOneSlopeAtTheSurfaceAndThePaperTwo) {
  const double h = 1e-9;
  EXPECT_NEAR(slope(smooth, -2 * h, h), K, 1e-3 * K);
  EXPECT_NEAR(slope(smooth, 2 * h, h), K, 1e-3 * K);
  EXPECT_NEAR(slope(paper, -2 * h, h), 2.0 * K, 1e-3 * K);
  EXPECT_NEAR(slope(paper, 2 * h, h), K, 1e-3 * K);
}

TEST(Precontact, StoresTheIntegralOfItsForce) {
  for (const auto* law : {&smooth, &paper}) {
    double energy = 0.0;
    const double step = 1e-6;
    for (double x = -w; x < 3e-3; x += step) energy += force(*law, x + 0.5 * step) * step;
    EXPECT_NEAR(law->stored_energy(3e-3) / energy, 1.0, 1e-3);
    EXPECT_NEAR(law->stored_energy(0.0), law->stored_energy(1e-15), 1e-12);
  }
}

}  // namespace
}  // namespace kerf::models

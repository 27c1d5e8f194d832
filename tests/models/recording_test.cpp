#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/recording.h>

namespace kerf::models {
namespace {

const Options three_points{{"points", 3.0}, {"first", 0.2}, {"last", 0.6}, {"loop", true}};

Recording<double> scissors(const Options& options = three_points) {
  return Recording<double>::make(std::vector{1.0, 3.0, 2.0, -1.0, -1.5, -0.5}, options);
}

double still(const Recording<double>& law, double penetration, double velocity) {
  Recording<double>::State state;
  return law.step(state, {.penetration = penetration, .velocity = velocity}, 1e-3);
}

TEST(Recording, LooksUpTheBranchOfTheMotion) {
  EXPECT_DOUBLE_EQ(still(scissors(), 0.2, 0.1), 1.0);
  EXPECT_DOUBLE_EQ(still(scissors(), 0.3, 0.1), 2.0);
  EXPECT_DOUBLE_EQ(still(scissors(), 0.5, 0.1), 2.5);
  EXPECT_DOUBLE_EQ(still(scissors(), 0.5, -0.1), -1.0);
}

TEST(Recording, HoldsBeforeTheTableAndCarriesTheTrendOnPastIt) {
  EXPECT_DOUBLE_EQ(still(scissors(), 0.0, 0.1), 1.0);
  EXPECT_NEAR(still(scissors(), 0.8, 0.1), 1.0, 1e-12);
}

TEST(Recording, GivesNoForceAtZeroVelocityWithinARampBand) {
  Options options = three_points;
  options["ramp_band"] = 0.05;
  EXPECT_EQ(still(scissors(options), 0.3, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(still(scissors(options), 0.3, 0.025), 1.0);
}

TEST(Recording, HasOneTableWithoutALoop) {
  const auto law = Recording<double>::make(std::vector{0.0, 4.0}, {{"points", 2.0}});
  EXPECT_DOUBLE_EQ(still(law, 0.25, -0.1), 1.0);
}

TEST(Recording, RefusesATableWithoutExtent) {
  EXPECT_THROW(
      Recording<double>::make(std::vector{0.0, 4.0}, {{"points", 2.0}, {"first", 1.0}, {"last", 1.0}}),
      std::invalid_argument);
}

}  // namespace
}  // namespace kerf::models

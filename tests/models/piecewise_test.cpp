#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/piecewise.h>

namespace kerf::models {
namespace {

const Options two_segments{{"segments", 2.0}};
const Options two_segment_loop{{"segments", 2.0}, {"loop", true}};

double still(const Piecewise<double>& law, double penetration, double velocity = 0.0) {
  Piecewise<double>::State state;
  return law.step(state, {.penetration = penetration, .velocity = velocity}, 1e-3);
}

TEST(Piecewise, IsLinearBetweenItsKnots) {
  const auto law = Piecewise<double>::make(std::vector{0.0, 1.0, 3.0, 2.0, 4.0, 0.0}, two_segments);
  EXPECT_DOUBLE_EQ(still(law, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(still(law, 0.5), 3.0);
  EXPECT_DOUBLE_EQ(still(law, 1.0), 4.0);
  EXPECT_DOUBLE_EQ(still(law, 2.5), 1.0);
}

TEST(Piecewise, HoldsBeforeTheFirstKnotAndGoesOnPastTheLast) {
  const auto law = Piecewise<double>::make(std::vector{0.0, 1.0, 3.0, 2.0, 4.0, 0.0}, two_segments);
  EXPECT_DOUBLE_EQ(still(law, -5.0), 2.0);
  EXPECT_DOUBLE_EQ(still(law, 4.0), -2.0);
}

TEST(Piecewise, OpensWithForcesOfItsOwnInALoop) {
  const auto law =
      Piecewise<double>::make(std::vector{0.0, 1.0, 3.0, 2.0, 4.0, 0.0, -1.0, -2.0, 0.0}, two_segment_loop);
  EXPECT_DOUBLE_EQ(still(law, 0.5, 0.1), 3.0);
  EXPECT_DOUBLE_EQ(still(law, 0.5, -0.1), -1.5);
}

TEST(Piecewise, RefusesKnotsThatDoNotIncrease) {
  EXPECT_THROW(Piecewise<double>::make(std::vector{0.0, 1.0, 1.0, 2.0, 4.0, 0.0}, two_segments),
               std::invalid_argument);
}

TEST(Piecewise, NamesItsParameters) {
  const auto parameters = Piecewise<double>::parameters(two_segment_loop);
  ASSERT_EQ(parameters.size(), 9U);
  EXPECT_EQ(parameters[1].name, "knot[1]");
  EXPECT_EQ(parameters[5].name, "closing[2]");
  EXPECT_EQ(parameters[6].name, "opening[0]");
  EXPECT_THROW(Piecewise<double>::parameters({{"segments", 17.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::models

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/scissors_free.h>

namespace kerf::models {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double lever = 0.28 / 7.58;
const ScissorsFree scissors = ScissorsFree::make(std::vector{0.002, 0.3, 5.0, 1000.0, 2.0}, {{"edge", 0.03}});

SpatialMotion at(double theta, double theta_rate, double x_s) { return {{theta, x_s}, {theta_rate, 0.0}}; }

TEST(MaterialEdge, PushesBackUpToItsLargestForceAndThenGivesWay) {
  const MaterialEdge edge{.stiffness_n_per_m = 1000.0, .largest_force_n = 2.0};
  MaterialEdge::State state{.edge_m = 0.03};
  EXPECT_EQ(edge.step(state, 0.0299).force_n, 0.0);
  EXPECT_FALSE(edge.step(state, 0.03).contact);
  EXPECT_NEAR(edge.step(state, 0.031).force_n, -1.0, 1e-12);
  EXPECT_EQ(state.edge_m, 0.03) << "below f_max the edge stays";
  EXPECT_EQ(edge.step(state, 0.035).force_n, -2.0);
  EXPECT_NEAR(state.edge_m, 0.033, 1e-15) << "above it the edge moves with the cutting point";
  EXPECT_NEAR(edge.step(state, 0.034).force_n, -1.0, 1e-12) << "and does not come back";
}

TEST(Scissors, CutOnlyWhatTheCuttingPointHasReached) {
  // x_c(10 deg) = 23.18 mm: 30 mm is reached with x_s = 7 mm.
  const double x_c = 23.1825114283e-3;
  auto state = scissors.initial_state();
  const AxisValues before = scissors.step(state, at(10.0 * degree, -1.0, 0.0065), 1e-3);
  EXPECT_NEAR(before[0], (0.002 + 0.3 * x_c) / lever, 1e-9) << "friction alone";
  EXPECT_EQ(before[1], 0.0);
  const AxisValues in = scissors.step(state, at(10.0 * degree, -1.0, 0.0075), 1e-3);
  EXPECT_NEAR(in[0], (0.002 + 5.3 * x_c) / lever, 1e-9);
  EXPECT_NEAR(in[1], -1000.0 * (x_c + 0.0075 - 0.03), 1e-9);
  const AxisValues opening = scissors.step(state, at(10.0 * degree, 1.0, 0.0075), 1e-3);
  EXPECT_NEAR(opening[0], -(0.002 + 0.3 * x_c) / lever, 1e-9);
}

TEST(Scissors, FeelNothingWhereTheBladesDoNotCut) {
  auto state = scissors.initial_state();
  EXPECT_EQ(scissors.step(state, at(1.0 * degree, -1.0, 0.1), 1e-3), AxisValues{});
  EXPECT_EQ(scissors.step(state, at(60.0 * degree, -1.0, 0.1), 1e-3), AxisValues{});
}

}  // namespace
}  // namespace kerf::models

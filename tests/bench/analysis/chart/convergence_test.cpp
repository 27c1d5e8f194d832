#include "chart/convergence.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

/// Refinements with an error of `size` times h^order.
std::vector<Refinement> of_order(double order, double size) {
  std::vector<Refinement> all;
  for (const double factor : {1.0, 2.0, 3.0, 4.0})
    all.push_back({"", factor, size * (std::pow(factor, -order) - std::pow(4.0, -order))});
  return all;
}

TEST(Convergence, FindsTheOrderAndTheErrorOfTheFinest) {
  for (const double order : {0.5, 1.0, 2.0}) {
    const Convergence found = convergence_of(of_order(order, 3.0));
    EXPECT_TRUE(found.known && found.converges);
    EXPECT_NEAR(found.order, order, 1e-9);
    EXPECT_NEAR(found.estimate_jnd, 3.0 * std::pow(4.0, -order), 1e-9);
  }
}

TEST(Convergence, SaysSoWhereThereIsNone) {
  auto all = of_order(1.0, 3.0);
  all[2].error_jnd = 2.0;  // three times the nodes are no nearer than twice
  EXPECT_FALSE(convergence_of(all).converges);
  EXPECT_TRUE(std::isnan(convergence_of(all).estimate_jnd));
  EXPECT_FALSE(convergence_of({{"", 1.0, 1.9}, {"", 2.0, 1.0}, {"", 4.0, 0.0}}).converges)
      << "twice the nodes halve an error at least";
}

TEST(Convergence, IsNoneWhereTheOrderIsNotSteady) {
  auto all = of_order(1.0, 3.0);  // 2.25, 0.75, 0.25, 0
  all[2].error_jnd = 0.4;
  const Convergence found = convergence_of(all);
  EXPECT_FALSE(found.converges);
  EXPECT_NEAR(found.expected_jnd, 0.25, 1e-9);
  EXPECT_NEAR(found.estimate_jnd, 0.75, 1e-9) << "as far as can be told";
}

TEST(Convergence, IsNotKnownWithoutFourTimesTheNodes) {
  EXPECT_FALSE(convergence_of({{"", 1.0, 1.0}, {"", 2.0, 0.0}}).known);
}

}  // namespace
}  // namespace kerf::bench

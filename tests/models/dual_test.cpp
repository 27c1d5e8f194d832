// The dual numbers of laws that are compiled outside, against differences, and the units of their parameters.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/dual.h>
#include <kerf/plugin.h>

namespace kerf::models {
namespace {

using Two = Dual<2>;

/// By each of two numbers.
template <typename F>
void expect_derivatives(const F& f, double x, double y) {
  Two dual_x(x);
  Two dual_y(y);
  dual_x.v[0] = 1.0;
  dual_y.v[1] = 1.0;
  const Two result = f(dual_x, dual_y);
  constexpr double h = 1e-6;
  EXPECT_DOUBLE_EQ(result.a, f(Two(x), Two(y)).a);
  EXPECT_NEAR(result.v[0], (f(Two(x + h), Two(y)).a - f(Two(x - h), Two(y)).a) / (2.0 * h), 1e-7);
  EXPECT_NEAR(result.v[1], (f(Two(x), Two(y + h)).a - f(Two(x), Two(y - h)).a) / (2.0 * h), 1e-7);
}

TEST(Dual, HasTheDerivativesOfItsArithmetic) {
  expect_derivatives([](Two x, Two y) { return x + y - 2.0 * x * y / (1.0 + x); }, 0.7, -1.3);
  expect_derivatives(
      [](Two x, Two y) {
        x += y;
        x *= y;
        x /= 3.0;
        x -= 1.0;
        return -x;
      },
      0.7, -1.3);
}

TEST(Dual, HasTheDerivativesOfItsFunctions) {
  expect_derivatives([](Two x, Two y) { return sqrt(x) * exp(y) + expm1(x * y) + log(x) - log1p(x); }, 0.7,
                     -0.3);
  expect_derivatives([](Two x, Two y) { return sin(x) + cos(y) * tan(x) - atan(y); }, 0.7, -0.3);
  expect_derivatives([](Two x, Two y) { return sinh(x) * cosh(y) - tanh(x + y) + abs(y); }, 0.7, -0.3);
  expect_derivatives([](Two x, Two y) { return pow(x, 1.5) + pow(x, y) + pow(2.0, y); }, 0.7, -0.3);
}

TEST(Dual, IsComparedByItsValue) {
  Two one(1.0);
  one.v[0] = 5.0;
  EXPECT_TRUE(one == 1.0 && one <= 1.0 && one >= 1.0 && one < 2.0 && one > 0.0 && one != 2.0);
  EXPECT_TRUE(isfinite(one));
  EXPECT_FALSE(isfinite(one / 0.0));
}

TEST(PluginHeader, NamesUnitsAsTheHouseDoes) {
  for (int i = 0; i <= static_cast<int>(Quantity::surface_stiffness); ++i) {
    const auto quantity = static_cast<Quantity>(i);
    EXPECT_EQ(plugin::unit_text(quantity), unit_of(quantity, "N", "m")) << i;
  }
}

}  // namespace
}  // namespace kerf::models

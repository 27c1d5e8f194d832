// A plug-in's law is fitted as the same law of the house is, with derivatives of its own and without.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/fit.h>
#include <kerf/models/foreign.h>

#include "fitting/strokes.h"
#include "support/foreign_friction.h"

namespace kerf::fitting {
namespace {

using models::Law;
using test::Strokes;
using test::foreign_friction::described;

const std::vector<double> values{0.3, 4.0, -0.2, 0.5, 0.01};

std::string registered(const char* name, bool with_derivatives) {
  models::register_law(described(name, with_derivatives), {.path = "./x.so", .name = "x.so", .sha256 = name});
  return name;
}

void expect_the_same(const FitResult& own, const FitResult& house, double relative) {
  ASSERT_TRUE(own.converged) << own.message;
  ASSERT_EQ(own.parameters.size(), house.parameters.size());
  for (std::size_t i = 0; i < own.parameters.size(); ++i) {
    const Estimate& of_house = house.parameters[i];
    EXPECT_NEAR(own.parameters[i].value, of_house.value, relative * std::abs(of_house.value))
        << of_house.info.name;
    EXPECT_NEAR(own.parameters[i].std_error, of_house.std_error, 1e-4 * of_house.std_error)
        << of_house.info.name;
  }
  EXPECT_NEAR(own.rmse, house.rmse, 1e-9 * house.rmse);
}

TEST(ForeignFit, AgreesWithTheHouseToEightDigitsWithDerivativesAndWithout) {
  const Strokes strokes(6000, 0.05, Law::make("friction", values));
  const FitResult house = fit("friction", strokes.series(), {.folds = 0});
  expect_the_same(fit(registered("with_derivatives", true), strokes.series(), {.folds = 0}), house, 1e-8);
  expect_the_same(fit(registered("by_differences", false), strokes.series(), {.folds = 0}), house, 1e-8);
}

TEST(ForeignFit, HoldsWhatIsNotSearched) {
  static std::vector<kerf_law_parameter_v1> some(std::begin(test::foreign_friction::parameters),
                                                 std::end(test::foreign_friction::parameters));
  some[0].flags = 0;
  some[0].initial = 0.3;
  kerf_law_v1 law = described("holds_offset", false);
  law.parameters = some.data();
  models::register_law(law, {.path = "./h.so", .name = "h.so", .sha256 = "h"});
  const Strokes strokes(4000, 0.01, Law::make("friction", values));
  const FitResult result = fit("holds_offset", strokes.series(), {.folds = 0});
  EXPECT_EQ(result.free_parameters, 4U);
  EXPECT_EQ(result.parameters[0].value, 0.3);
  EXPECT_EQ(result.parameters[0].std_error, 0.0);
  EXPECT_NEAR(result.parameters[1].value, 4.0, 0.1);
}

TEST(ForeignFit, FindsWhatIsNotLinearFarFromItsInitialValues) {
  // F = a (exp(x / b) - 1): b is three hundred times smaller than its plug-in thought.
  static const kerf_law_parameter_v1 parameters[] = {
      {"a", "N", "scale", 1e-6, 1e6, 1.0, KERF_SEARCHED | KERF_LOGARITHMIC},
      {"b", "m", "length", 1e-6, 1e6, 60.0, KERF_SEARCHED | KERF_LOGARITHMIC}};
  kerf_law_v1 law = described("own_exponential", false);
  law.parameters = parameters;
  law.parameter_count = 2;
  law.step = [](const double* p, void*, const double* x, const double*, double, double* force) {
    *force = p[0] * std::expm1(*x / p[1]);
  };
  models::register_law(law, {.path = "./e.so", .name = "e.so", .sha256 = "e"});
  const Strokes strokes(4000, 0.0, Law::make("own_exponential", std::vector{0.05, 0.2}));
  const FitResult result = fit("own_exponential", strokes.series(), {.folds = 0});
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_NEAR(result.parameters[0].value, 0.05, 1e-6);
  EXPECT_NEAR(result.parameters[1].value, 0.2, 1e-6);
}

TEST(ForeignFit, FindsWhatIsLinearAtItsUpperBound) {
  static std::vector<kerf_law_parameter_v1> bounded(std::begin(test::foreign_friction::parameters),
                                                    std::end(test::foreign_friction::parameters));
  bounded[1].initial = 2.0;
  bounded[1].upper = 3.0;  // and the data say 4
  kerf_law_v1 with_derivatives = described("bounded", true);
  kerf_law_v1 without = described("bounded_by_differences", false);
  for (kerf_law_v1* const law : {&with_derivatives, &without}) {
    law->parameters = bounded.data();
    models::register_law(*law, {.path = "./b.so", .name = "b.so", .sha256 = law->name});
  }
  const Strokes strokes(4000, 0.01, Law::make("friction", values));
  const FitResult own = fit("bounded", strokes.series(), {.folds = 0});
  EXPECT_NEAR(own.parameters[1].value, 3.0, 1e-9);
  const FitResult by_differences = fit("bounded_by_differences", strokes.series(), {.folds = 0});
  for (std::size_t i = 0; i < own.parameters.size(); ++i)
    EXPECT_NEAR(by_differences.parameters[i].value, own.parameters[i].value, 1e-6) << i;
}

TEST(ForeignFit, SharesParametersAmongRecordingsAndKeepsTheirOwn) {
  const Strokes slow(3000, 0.01, Law::make("friction", values));
  const Strokes stiff(3000, 0.01, Law::make("friction", std::vector{0.3, 8.0, -0.2, 0.5, 0.01}));
  const std::vector<Series> both{slow.series(), stiff.series()};
  const FitResult result =
      fit(registered("of_two", true), both, {.folds = 0, .per_recording = {"stiffness"}});
  EXPECT_NEAR(result.law(0).values()[1], 4.0, 0.1);
  EXPECT_NEAR(result.law(1).values()[1], 8.0, 0.1);
}

}  // namespace
}  // namespace kerf::fitting

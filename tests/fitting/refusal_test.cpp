#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/fit.h>

#include "fitting/strokes.h"

namespace kerf::fitting {
namespace {

using test::Strokes;
using testing::HasSubstr;

const models::Law kelvin = models::Law::make("kelvin", std::vector{5.0, 8.0, 1.6});

std::string refusal(const Strokes& strokes, std::string_view model = "kelvin",
                    const FitOptions& options = {}) {
  try {
    (void)fit(model, strokes.series(), options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Refusal, OfAConstantPosition) {
  Strokes strokes(100, 0.0, kelvin);
  strokes.penetration.assign(100, 0.1);
  EXPECT_THAT(refusal(strokes), HasSubstr("the position is constant"));
}

TEST(Refusal, OfALawThatActsOnSeveralAxes) {
  EXPECT_THAT(refusal(Strokes(2000, 0.0, kelvin), "blade"),
              HasSubstr("law 'blade' acts on several axes and cannot be fitted along one"));
}

TEST(Refusal, OfTooFewSamples) {
  EXPECT_THAT(refusal(Strokes(2, 0.0, kelvin)), HasSubstr("only 2 samples"));
  EXPECT_THAT(refusal(Strokes(50, 0.0, kelvin), "recording"), HasSubstr("101 parameters"));
}

TEST(Refusal, OfSamplesThatAreNotFinite) {
  Strokes strokes(100, 0.0, kelvin);
  strokes.force[17] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(strokes), HasSubstr("the force of sample 17 is not finite"));
}

TEST(Refusal, OfTimeThatStandsStill) {
  Strokes strokes(100, 0.0, kelvin);
  strokes.time_s[9] = strokes.time_s[8];
  EXPECT_THAT(refusal(strokes), HasSubstr("the time does not increase at sample 9"));
}

TEST(Refusal, OfColumnsOfDifferentLength) {
  Strokes strokes(100, 0.0, kelvin);
  strokes.velocity.pop_back();
  EXPECT_THAT(refusal(strokes), HasSubstr("differ in length"));
}

TEST(Refusal, OfAnUnknownLawOrOption) {
  EXPECT_THAT(refusal(Strokes(100, 0.0, kelvin), "burgers"), HasSubstr("unknown law 'burgers'"));
  EXPECT_THAT(refusal(Strokes(100, 0.0, kelvin), "kelvin", {.law_options = {{"speed", 1.0}}}),
              HasSubstr("'speed'"));
}

TEST(Refusal, OfAForceThatIsZeroThroughout) {
  Strokes strokes(400, 0.0, kelvin);
  strokes.force.assign(400, 0.0);
  EXPECT_THAT(refusal(strokes), HasSubstr("the force is zero throughout"));
}

TEST(Warning, OfMoreSegmentsThanTheDataCarry) {
  const Strokes strokes(30, 0.0, kelvin);
  const auto result = fit("piecewise", strokes.series(), {.law_options = {{"segments", 12.0}}});
  EXPECT_FALSE(result.converged);
  EXPECT_FALSE(result.warnings.empty());
}

}  // namespace
}  // namespace kerf::fitting

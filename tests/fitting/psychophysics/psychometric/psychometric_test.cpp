#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/psychophysics/psychometric.h>

namespace kerf::psychophysics {
namespace {

TEST(Psychometric, PassesItsThresholdWhereItsShapeSays) {
  const double guess = 0.5;
  const double lapse = 0.02;
  const auto at_threshold = [&](Shape shape, double f) {
    const Psychometric curve{.shape = shape, .threshold = 0.8, .slope = 3.0, .guess = guess, .lapse = lapse};
    EXPECT_NEAR(curve.probability(0.8), guess + (1.0 - guess - lapse) * f, 1e-14);
  };
  at_threshold(Shape::weibull, 1.0 - std::exp(-1.0));
  at_threshold(Shape::logistic, 0.5);
  at_threshold(Shape::gaussian, 0.5);
}

TEST(Psychometric, IsTheCurveOfItsName) {
  const Psychometric weibull{.threshold = 2.0, .slope = 1.7, .guess = 0.0, .lapse = 0.0};
  EXPECT_NEAR(weibull.probability(3.0), 1.0 - std::exp(-std::pow(1.5, 1.7)), 1e-14);
  const Psychometric logistic{.shape = Shape::logistic,
                              .axis = Axis::linear,
                              .threshold = 2.0,
                              .slope = 1.7,
                              .guess = 0.0,
                              .lapse = 0.0};
  EXPECT_NEAR(logistic.probability(3.0), 1.0 / (1.0 + std::exp(-1.7)), 1e-14);
  const Psychometric gaussian{.shape = Shape::gaussian,
                              .axis = Axis::linear,
                              .threshold = 2.0,
                              .slope = 1.0,
                              .guess = 0.0,
                              .lapse = 0.0};
  EXPECT_NEAR(gaussian.probability(3.0), 0.8413447460685429, 1e-14);
}

TEST(Psychometric, BeginsAtGuessingAndEndsAtLapses) {
  for (const Shape shape : {Shape::weibull, Shape::logistic, Shape::gaussian}) {
    const Psychometric curve{.shape = shape, .guess = 1.0 / 3.0, .lapse = 0.03};
    EXPECT_DOUBLE_EQ(curve.probability(0.0), 1.0 / 3.0);
    EXPECT_NEAR(curve.probability(1e9), 0.97, 1e-12);
    for (const double p : {0.4, 0.7, 0.95}) EXPECT_NEAR(curve.probability(curve.intensity_at(p)), p, 1e-12);
  }
}

TEST(Psychometric, RefusesWhatCannotBe) {
  EXPECT_THROW((void)(Psychometric{.axis = Axis::linear}.probability(1.0)), std::invalid_argument);
  EXPECT_THROW((void)(Psychometric{.threshold = 0.0}.probability(1.0)), std::invalid_argument);
  EXPECT_THROW((void)(Psychometric{.slope = 0.0}.probability(1.0)), std::invalid_argument);
  EXPECT_THROW((void)(Psychometric{.guess = 0.9, .lapse = 0.1}.probability(1.0)), std::invalid_argument);
  EXPECT_THROW((void)(Psychometric{}.probability(-1.0)), std::invalid_argument);
  EXPECT_THROW((void)(Psychometric{}.intensity_at(0.5)), std::invalid_argument);
  EXPECT_THROW((void)(Psychometric{}.intensity_at(0.98)), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics

#include <array>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/psychophysics/sequential/bayes_factor.h>

namespace kerf::psychophysics {
namespace {

// SciPy: quad of nct.pdf(t, n - 1, d sqrt(n)) cauchy.pdf(d, 0, 1 / sqrt(2)) over d, by t.pdf(t, n - 1).
TEST(BayesFactor, AgreesWithTheIntegralOverTheNoncentralT) {
  const auto expect = [](double t, int subjects, double two_sided, double one_sided) {
    EXPECT_NEAR(bayes_factor_of_t(t, subjects) / two_sided, 1.0, 1e-6) << t;
    EXPECT_NEAR(bayes_factor_of_t(t, subjects, {.positive_alone = true}) / one_sided, 1.0, 1e-6) << t;
  };
  expect(2.03, 20, 1.2616274271153831, 2.435162867759869);
  expect(0.5, 12, 0.32013838772397896, 0.4320817917887523);
  expect(3.5, 12, 10.485090213262493, 20.87755124556873);
  expect(-1.2, 8, 0.5861771646295217, 0.18184078385622687);
  expect(5.0, 24, 537.4756701581488, 1074.9020677255967);
}

TEST(BayesFactor, IsThatOfStudentsTOfTheValues) {
  const std::array values{0.1, 0.3, -0.05, 0.2, 0.15};
  const double t = 0.14 / std::sqrt(0.067 / 4.0 / 5.0);
  EXPECT_NEAR(bayes_factor(values), bayes_factor_of_t(t, 5), 1e-9);
}

TEST(BayesFactor, IsNoNumberWhereAllSubjectsAreTheSame) {
  EXPECT_TRUE(std::isnan(bayes_factor(std::array{0.25, 0.25, 0.25})));
  EXPECT_THROW((void)bayes_factor(std::array{0.25}), std::invalid_argument);
  EXPECT_THROW((void)bayes_factor_of_t(1.0, 12, {.scale = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics

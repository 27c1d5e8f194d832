#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/psychophysics/detection/same_different.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

constexpr int many = 100'000'000;

Count share_of(double rate, int trials = many) {
  return {.successes = static_cast<int>(std::lround(rate * trials)), .trials = trials};
}

TEST(SameDifferent, HasTheRatesOfItsRule) {
  // By NumPy on two million nodes.
  const auto expect = [](double d, double k, double hit, double false_alarm) {
    const SameDifferentRates rates = same_different_rates(SameRule::likelihood, d, k);
    EXPECT_NEAR(rates.hit, hit, 2e-7) << d << ' ' << k;
    EXPECT_NEAR(rates.false_alarm, false_alarm, 2e-7) << d << ' ' << k;
  };
  expect(1.0, 0.0, 0.573315748, 0.426684252);
  expect(1.0, 0.3, 0.244194015, 0.133038000);
  expect(2.0, -0.5, 0.863848674, 0.430532878);
  expect(0.5, 0.05, 0.258297081, 0.224328789);
  expect(3.0, 1.2, 0.735463919, 0.045247650);
}

TEST(SameDifferent, WithoutALeaningHasTheShareOfItsTask) {
  for (const double d : {0.3, 1.0, 2.5}) {
    const SameDifferentRates rates = same_different_rates(SameRule::likelihood, d, 0.0);
    EXPECT_NEAR(rates.hit, proportion_correct({Decision::same_different}, d), 1e-7);
    EXPECT_NEAR(rates.hit + rates.false_alarm, 1.0, 1e-7);
  }
}

// The rule itself, applied to drawn observations.
TEST(SameDifferent, IsWhatObserversDo) {
  Random random(5);
  const double d = 1.5;
  const double k = 0.4;
  constexpr int trials = 200'000;
  int hits = 0;
  int false_alarms = 0;
  for (int i = 0; i < trials; ++i) {
    const auto says_different = [&](double first, double second) {
      const auto log_likelihood = [&](double at, double x) { return -0.5 * (x - at) * (x - at); };
      const double x = first + random.normal();
      const double y = second + random.normal();
      const auto both = [&](double a, double b) {
        return std::exp(log_likelihood(a, x) + log_likelihood(b, y));
      };
      return both(0.0, d) + both(d, 0.0) > std::exp(k) * (both(0.0, 0.0) + both(d, d));
    };
    hits += says_different(0.0, d) ? 1 : 0;
    false_alarms += says_different(d, d) ? 1 : 0;
  }
  const SameDifferentRates rates = same_different_rates(SameRule::likelihood, d, k);
  const double error = 4.0 * std::sqrt(0.25 / trials);
  EXPECT_NEAR(static_cast<double>(hits) / trials, rates.hit, error);
  EXPECT_NEAR(static_cast<double>(false_alarms) / trials, rates.false_alarm, error);
}

TEST(SameDifferent, FindsTheObserverThatMadeTheRates) {
  for (const SameRule rule : {SameRule::differencing, SameRule::likelihood}) {
    for (const double k : {0.3, 1.3}) {
      const SameDifferentRates rates = same_different_rates(rule, 1.8, k);
      const Detection found = same_different(rule, share_of(rates.hit), share_of(rates.false_alarm));
      EXPECT_NEAR(found.d_prime, 1.8, 1e-5);
      EXPECT_NEAR(found.criterion, k, 1e-5);
      EXPECT_NEAR(same_different_d_prime(rule, rates), 1.8, 1e-9);
    }
    EXPECT_EQ(same_different(rule, {10, 40}, {12, 40}).d_prime, 0.0);
  }
  const SameDifferentRates leaning = same_different_rates(SameRule::likelihood, 1.8, -0.7);
  EXPECT_NEAR(
      same_different(SameRule::likelihood, share_of(leaning.hit), share_of(leaning.false_alarm)).criterion,
      -0.7, 1e-5);
}

TEST(SameDifferent, HasTheErrorThatCountsGive) {
  // d' moves by this when either rate moves by its own standard error.
  for (const SameRule rule : {SameRule::differencing, SameRule::likelihood}) {
    const Detection found = same_different(rule, {60000, 100000}, {20000, 100000});
    const double by_hits = same_different(rule, {60155, 100000}, {20000, 100000}).d_prime - found.d_prime;
    const double by_alarms = same_different(rule, {60000, 100000}, {20126, 100000}).d_prime - found.d_prime;
    EXPECT_NEAR(found.standard_error, std::hypot(by_hits, by_alarms), 0.01 * found.standard_error);
    EXPECT_NEAR(found.interval.upper, found.d_prime + 1.959964 * found.standard_error, 1e-3);
  }
}

TEST(SameDifferent, HasTheIntervalOfTheLikelihoodRatio) {
  // By SciPy: the criterion minimised, the ends by Brent.
  const Detection found = same_different(SameRule::differencing, {38, 50}, {15, 50});
  EXPECT_NEAR(found.d_prime, 2.45189788, 1e-6);
  EXPECT_NEAR(found.criterion, 1.46573816, 1e-6);
  EXPECT_NEAR(found.interval.lower, 1.7530303944, 1e-5);
  EXPECT_NEAR(found.interval.upper, 3.1411676719, 1e-5);
  const Detection few = same_different(SameRule::differencing, {9, 13}, {5, 12});
  EXPECT_EQ(few.interval.lower, 0.0);
  EXPECT_NEAR(few.interval.upper, 3.12861690730, 1e-5);
}

TEST(SameDifferent, CoversTheObserversDPrime) {
  for (const SameRule rule : {SameRule::differencing, SameRule::likelihood}) {
    const SameDifferentRates rates =
        same_different_rates(rule, 1.7, rule == SameRule::likelihood ? 0.2 : 1.6);
    Random random(11);
    constexpr int runs = 250;
    int covered = 0;
    for (int run = 0; run < runs; ++run) {
      const Count hits{.successes = random.successes(40, rates.hit), .trials = 40};
      const Count false_alarms{.successes = random.successes(40, rates.false_alarm), .trials = 40};
      const Interval interval = same_different(rule, hits, false_alarms).interval;
      covered += interval.lower <= 1.7 && 1.7 <= interval.upper ? 1 : 0;
    }
    EXPECT_GT(clopper_pearson({covered, runs}, 0.999).upper, 0.95);
    EXPECT_LT(clopper_pearson({covered, runs}, 0.999).lower, 0.95);
  }
}

TEST(SameDifferent, RefusesWhatCannotBe) {
  EXPECT_THROW((void)same_different_rates(SameRule::differencing, 1.0, -0.1), std::invalid_argument);
  EXPECT_THROW((void)same_different_rates(SameRule::likelihood, -1.0, 0.0), std::invalid_argument);
  EXPECT_THROW((void)same_different(SameRule::likelihood, {0, 0}, {1, 2}), std::invalid_argument);
  EXPECT_THROW((void)same_different_d_prime(SameRule::likelihood, {.hit = 1.0, .false_alarm = 0.5}),
               std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics

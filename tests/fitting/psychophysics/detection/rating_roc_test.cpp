#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/detection/rating_roc.h>
#include <kerf/psychophysics/random.h>

namespace kerf::psychophysics {
namespace {

const Ratings many_ratings{.noise = {174, 172, 104, 92, 41, 8}, .signal = {46, 57, 66, 101, 154, 173}};
const Ratings few_ratings{.noise = {12, 9, 6, 4, 0, 1}, .signal = {2, 3, 5, 6, 9, 7}};

TEST(RocArea, IsThatOfMannAndWhitneyWithDelongsError) {
  // Pair by pair in NumPy.
  EXPECT_NEAR(roc_area(many_ratings).value, 0.8031188089346903, 1e-12);
  EXPECT_NEAR(roc_area(many_ratings).standard_error, 0.012559767308691698, 1e-12);
  EXPECT_NEAR(roc_area(few_ratings).value, 0.8349609375, 1e-12);
  EXPECT_NEAR(roc_area(few_ratings).standard_error, 0.05079033630712914, 1e-12);
}

TEST(RocArea, TellsNothingOfAnIntervalWhereNothingOverlaps) {
  const RocArea area = roc_area({.noise = {10, 0}, .signal = {0, 10}});
  EXPECT_EQ(area.value, 1.0);
  EXPECT_EQ(area.interval.lower, 0.0);
  EXPECT_EQ(area.interval.upper, 1.0);
}

// The largest likelihood that SciPy finds by Nelder and Mead and by BFGS, errors by its expected information.
TEST(NormalRoc, IsTheLargestLikelihood) {
  const NormalRoc found = fit_normal_roc(many_ratings);
  EXPECT_NEAR(found.log_likelihood, -1920.9847422270695, 1e-7);
  EXPECT_NEAR(found.mean, 1.5190518, 2e-5);
  EXPECT_NEAR(found.deviation, 1.4168960, 2e-5);
  EXPECT_NEAR(found.d_a, 1.2387338, 1e-5);
  EXPECT_NEAR(found.d_a_error, 0.06663571, 1e-5);
  EXPECT_NEAR(found.mean_error, 0.09605207, 1e-5);
  EXPECT_NEAR(found.log_deviation_error, 0.06288045, 1e-5);
  EXPECT_NEAR(found.criteria.front(), -0.533099, 1e-4);
  EXPECT_NEAR(found.criteria.back(), 2.294001, 1e-4);
  EXPECT_EQ(found.degrees_of_freedom, 3);
  const NormalRoc few = fit_normal_roc(few_ratings);
  EXPECT_NEAR(few.log_likelihood, -101.2303926073661, 1e-7);
  EXPECT_NEAR(few.d_a, 1.4210852, 1e-5);
  EXPECT_NEAR(few.d_a_error, 0.29036603, 1e-5);
}

TEST(NormalRoc, OfEqualVariancesHasADPrime) {
  const NormalRoc found = fit_normal_roc(many_ratings, true);
  EXPECT_NEAR(found.log_likelihood, -1936.7299526264685, 1e-7);
  EXPECT_NEAR(found.d_a, 1.2531771, 1e-5);
  EXPECT_EQ(found.d_a, found.mean);
  EXPECT_NEAR(found.d_a_error, 0.06541357, 1e-6);
  EXPECT_EQ(found.deviation, 1.0);
  // Of yes and no alone it is z(H) - z(F).
  const NormalRoc two = fit_normal_roc({.noise = {70, 30}, .signal = {20, 80}}, true);
  EXPECT_NEAR(two.d_a, 0.5244005127 + 0.8416212336, 1e-8);
}

TEST(NormalRoc, LeavesOutCategoriesThatNobodyNamed) {
  const NormalRoc with = fit_normal_roc({.noise = {12, 0, 9, 6, 0, 5}, .signal = {2, 0, 5, 9, 0, 16}});
  const NormalRoc without = fit_normal_roc({.noise = {12, 9, 6, 5}, .signal = {2, 5, 9, 16}});
  EXPECT_EQ(with.d_a, without.d_a);
  EXPECT_EQ(with.criteria.size(), 3U);
}

TEST(NormalRoc, CoversTheObserversDistance) {
  const std::vector<double> criteria{-0.6, 0.1, 0.7, 1.3, 2.0};
  const double mean = 1.4;
  const double deviation = 1.25;
  const double distance = mean / std::sqrt(0.5 * (1.0 + deviation * deviation));
  const auto normal = [](double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); };
  double area = 0.0;  // in trapezia between these criteria
  for (std::size_t j = 0; j <= criteria.size(); ++j) {
    const auto below = [&](std::size_t end, double at, double size) {
      return end == 0 ? 0.0 : end > criteria.size() ? 1.0 : normal((criteria[end - 1] - at) / size);
    };
    const double noise = 0.5 * (below(j, 0.0, 1.0) + below(j + 1, 0.0, 1.0));
    area += noise * (below(j + 1, mean, deviation) - below(j, mean, deviation));
  }
  Random random(2);
  constexpr int runs = 800;
  int covered = 0;
  int area_covered = 0;
  const auto rated = [&](double x) {
    std::size_t category = 0;
    while (category < criteria.size() && x > criteria[category]) ++category;
    return category;
  };
  for (int run = 0; run < runs; ++run) {
    Ratings drawn{.noise = std::vector<int>(6), .signal = std::vector<int>(6)};
    for (int i = 0; i < 100; ++i) {
      ++drawn.noise[rated(random.normal())];
      ++drawn.signal[rated(mean + deviation * random.normal())];
    }
    const Interval interval = fit_normal_roc(drawn).d_a_interval;
    covered += interval.lower <= distance && distance <= interval.upper ? 1 : 0;
    const Interval of_area = roc_area(drawn).interval;
    area_covered += of_area.lower <= area && area <= of_area.upper ? 1 : 0;
  }
  for (const int count : {covered, area_covered}) {
    EXPECT_GT(clopper_pearson({count, runs}, 0.999).upper, 0.95);
    EXPECT_LT(clopper_pearson({count, runs}, 0.999).lower, 0.95);
  }
}

TEST(NormalRoc, RefusesWhatNoCurveFits) {
  EXPECT_THROW((void)fit_normal_roc({.noise = {10, 0, 0}, .signal = {0, 0, 10}}), std::invalid_argument);
  EXPECT_THROW((void)fit_normal_roc({.noise = {10, 5, 0}, .signal = {0, 0, 10}}), std::invalid_argument);
  EXPECT_THROW((void)fit_normal_roc({.noise = {10, 4}, .signal = {3, 9}}), std::invalid_argument);
  EXPECT_THROW((void)fit_normal_roc({.noise = {10, 4}, .signal = {3, 9, 1}}), std::invalid_argument);
  EXPECT_THROW((void)roc_area({.noise = {0, 0}, .signal = {3, 9}}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::psychophysics

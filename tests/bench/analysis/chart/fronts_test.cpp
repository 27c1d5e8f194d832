#include "chart/fronts.h"

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::ElementsAre;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

ChartPoint point(double p50_ns, double cold_p99_ns, double cold_p999_ns, double error_jnd) {
  const double values[] = {1.0, 1.0, 1.0};
  return {.law = "kelvin",
          .fidelity = {},
          .parameters = 3,
          .rate_hz = 1000.0,
          .cost = {.p50_ns = p50_ns, .cold = {.p99_ns = cold_p99_ns, .p999_ns = cold_p999_ns}},
          .error_jnd = error_jnd,
          .jnd_fraction = 0.0,
          .axis = {},
          .stability = {},
          .file = {.law = models::Law::make("kelvin", values)}};
}

SpeedAccuracy chart_with(std::vector<ChartPoint> points) {
  return {.source = {}, .reference = {}, .rate_hz = 1000.0, .points = std::move(points), .notes = {}};
}

TEST(Fronts, DifferWhereALawIsQuickWarmAndSlowCold) {
  // A table is as quick as a few products while it lies in the cache.
  SpeedAccuracy chart = chart_with({point(20.0, 900.0, 2000.0, 5.0), point(100.0, 300.0, 500.0, 5.0)});
  mark_fronts(chart);
  EXPECT_EQ(chart.cold_tail, ColdTail::p999);
  EXPECT_TRUE(chart.points[0].on_front && !chart.points[0].on_cold_front);
  EXPECT_TRUE(!chart.points[1].on_front && chart.points[1].on_cold_front);
}

TEST(Fronts, GoByP99WhereNobodyHasMore) {
  SpeedAccuracy chart = chart_with({point(20.0, 900.0, unknown, 5.0), point(100.0, 300.0, unknown, 5.0)});
  mark_fronts(chart);
  EXPECT_EQ(chart.cold_tail, ColdTail::p99);
  EXPECT_TRUE(chart.points[1].on_cold_front);
  chart = chart_with({point(20.0, unknown, unknown, 5.0)});
  mark_fronts(chart);
  EXPECT_EQ(chart.cold_tail, ColdTail::none);
  EXPECT_FALSE(chart.points[0].on_cold_front);
}

TEST(Fronts, HaveWhatIsCheapByMedianOrInTheColdNearThem) {
  SpeedAccuracy chart = chart_with({point(20.0, 900.0, unknown, 5.0),   // the cheapest, warm
                                    point(29.0, 2000.0, unknown, 5.0),  // less than half as dear again
                                    point(100.0, 300.0, unknown, 5.0),  // the cheapest, cold
                                    point(100.0, 900.0, unknown, 5.0),  // neither
                                    point(1e4, 1e5, unknown, 1.0)});  // dear, and nothing else errs as little
  EXPECT_THAT(near_fronts(chart), ElementsAre(0, 1, 2, 4));
  chart.rate_hz = 500.0;
  EXPECT_THAT(near_fronts(chart), ElementsAre()) << "at another rate";
}

TEST(Fronts, DoNotTakeForWithinTheJndWhatIsOutsideItAtTooManyTicks) {
  SpeedAccuracy chart = chart_with({point(20.0, 1.0, 1.0, 0.4), point(100.0, 1.0, 1.0, 0.8)});
  mark_fronts(chart);
  EXPECT_FALSE(chart.points[1].on_front) << "nobody feels the difference";
  chart.points[0].jnd_fraction = 0.06;
  EXPECT_FALSE(within_jnd(chart.points[0]));
  mark_fronts(chart);
  EXPECT_TRUE(chart.points[0].on_front) << "it is the cheapest still";
  EXPECT_TRUE(chart.points[1].on_front) << "and now there is something to pay for";
}

TEST(Fronts, GoByTheFoldsOfFits) {
  const auto fitted = [](std::vector<double> folds, double rmse) {
    fitting::FitResult fit;
    fit.cv_rmse = rmse;
    fit.cv_folds = std::move(folds);
    return std::make_shared<const fitting::FitResult>(std::move(fit));
  };
  ChartPoint one = point(20.0, 1.0, 1.0, 10.3);
  ChartPoint best = point(20.0, 1.0, 1.0, 10.0);
  EXPECT_FALSE(as_good_as(one, best, 0.1)) << "2.5 JND left out";
  one.fit = fitted({1.1, 0.9, 1.2, 0.91}, 1.03);
  best.fit = fitted({1.0, 1.0, 1.0, 1.0}, 1.0);
  EXPECT_TRUE(as_good_as(one, best, 0.1)) << "but no more than folds differ among themselves";
}

}  // namespace
}  // namespace kerf::bench

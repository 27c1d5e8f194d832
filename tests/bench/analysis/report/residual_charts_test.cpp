#include "report/residual_charts.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

/// r[i] = memory r[i-1] + white noise.
std::vector<double> coloured(double memory, std::size_t count) {
  std::mt19937 generator(7);
  std::normal_distribution<double> noise;
  std::vector<double> values{noise(generator)};
  while (values.size() < count) values.push_back(memory * values.back() + noise(generator));
  return values;
}

FitView view_of(const std::vector<double>& residual) {
  FitView view;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    view.series.time_s.push_back(1e-3 * static_cast<double>(i));
    view.series.penetration.push_back(1e-3 * static_cast<double>(i % 10));
    view.series.velocity.push_back(i % 2 == 0 ? 1.0 : -1.0);
  }
  view.position = {.factor = 1000.0, .unit = "mm"};
  view.force_unit = "N";
  return view;
}

FittedTrace trace_of(const std::vector<double>& residual, LawFile law, double correlation_time = 1.0) {
  return {.model = "kelvin",
          .fit = {{"correlation_time_samples", correlation_time}},
          .law = std::move(law),
          .force = {},
          .residual = residual};
}

LawFile any_law() { return {.law = models::Law::make("kelvin", std::vector{300.0, 500.0, 50.0})}; }

TEST(ResidualCharts, TheAutocorrelationOfANoiseWithMemoryIsItsPower) {
  const auto values = coloured(0.8, 200'000);
  const auto correlation = autocorrelation(values, 2, 8);
  ASSERT_EQ(correlation.size(), 5U);
  EXPECT_DOUBLE_EQ(correlation[0], 1.0);
  for (std::size_t k = 1; k < correlation.size(); ++k) {
    EXPECT_NEAR(correlation[k], std::pow(0.8, 2.0 * static_cast<double>(k)), 0.02) << k;
  }
}

TEST(ResidualCharts, TheBandIsThatOfWhiteNoiseAndTheLagIsInSeconds) {
  const auto values = coloured(0.0, 10'000);
  const Chart chart = residual_autocorrelation(view_of(values), trace_of(values, any_law()));
  ASSERT_EQ(chart.horizontal.size(), 2U);
  EXPECT_NEAR(chart.horizontal[0].at, 0.0196, 1e-6);
  EXPECT_NEAR(chart.curves.at(0).x.back(), 0.05, 1e-9);
}

TEST(ResidualCharts, TheHistogramHoldsTheSamplesAndTheNormalCurveOverThem) {
  const auto values = coloured(0.0, 50'000);
  const Chart chart = residual_histogram(view_of(values), trace_of(values, any_law()));
  const Curve& boxes = chart.curves.at(0);
  const Curve& normal = chart.curves.at(1);
  double samples = 0.0;
  double area = 0.0;
  for (std::size_t i = 0; i < boxes.y.size(); ++i) {
    samples += boxes.y[i];
    area += normal.y[i];
    EXPECT_NEAR(boxes.y[i], normal.y[i], 5.0 * std::sqrt(normal.y[i] + 10.0)) << i;
  }
  EXPECT_NEAR(samples, 50'000.0, 20.0) << "four deviations to each side";
  EXPECT_NEAR(area, 50'000.0, 20.0);
}

/// Every other second out of contact.
FitView half_judged(std::vector<double>& residual) {
  FitView view = view_of(residual);
  view.series.counts.resize(residual.size(), 1);
  for (std::size_t row = 0; row < residual.size(); ++row) {
    if (row / 1000 % 2 == 0) continue;
    view.series.counts[row] = 0;
    residual[row] = line_break;
  }
  return view;
}

TEST(ResidualCharts, RowsThatNoLawIsJudgedByAreGreyAndInNoNumber) {
  auto values = coloured(0.0, 10'000);
  const FitView view = half_judged(values);
  const FittedTrace trace = trace_of(values, any_law());
  const Chart over_time = residual_over_time(view, trace, 3.0);
  ASSERT_EQ(over_time.bands.size(), 5U);
  EXPECT_DOUBLE_EQ(over_time.bands[0].begin, 1.0);
  EXPECT_DOUBLE_EQ(over_time.bands[0].end, 2.0);
  EXPECT_EQ(over_time.bands[0].colour, Colour::grey);
  const Curve& line = over_time.curves.at(0);
  for (std::size_t i = 0; i < line.x.size(); ++i)
    EXPECT_EQ(std::isnan(line.y[i]), static_cast<int>(line.x[i] + 1e-9) % 2 == 1) << line.x[i];
  for (const Chart& chart :
       {residual_over_penetration(view, trace, 3.0), residual_over_velocity(view, trace, 3.0)}) {
    for (const Curve& curve : chart.curves)
      for (const double y : curve.y) EXPECT_TRUE(std::isfinite(y));
  }
  const Chart autocorrelation = residual_autocorrelation(view, trace);
  EXPECT_NEAR(autocorrelation.horizontal.at(0).at, 1.96 / std::sqrt(5'000.0), 1e-9);
  EXPECT_NEAR(autocorrelation.curves.at(0).y.at(0), 1.0, 1e-9);
  const Chart histogram = residual_histogram(view, trace);
  double samples = 0.0;
  for (const double count : histogram.curves.at(0).y) samples += count;
  EXPECT_NEAR(samples, 5'000.0, 10.0) << "four deviations to each side";
}

TEST(ResidualCharts, TheMeanInBinsFollowsWhatDependsOnThePosition) {
  std::vector<double> values;
  for (std::size_t i = 0; i < 1000; ++i) values.push_back(i % 10 == 9 ? 2.0 : 0.0);
  const Chart chart = residual_over_penetration(view_of(values), trace_of(values, any_law()), 3.0);
  const Curve& mean = chart.curves.back();
  EXPECT_DOUBLE_EQ(mean.y.back(), 2.0);
  EXPECT_DOUBLE_EQ(mean.y.front(), 0.0);
  EXPECT_NEAR(mean.x.back(), 9.0, 0.2) << "in millimetres";
}

}  // namespace
}  // namespace kerf::bench

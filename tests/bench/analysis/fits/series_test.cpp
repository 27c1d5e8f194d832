#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/analysis/choose/known_cuts.h"
#include "bench/analysis/choose/known_laws.h"
#include "fits/contact_rows.h"
#include "fits/fit_recording.h"
#include "fits/rendered_series.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;

AxisSeries series_of(std::size_t rows, double period_s) {
  AxisSeries series;
  for (std::size_t i = 0; i < rows; ++i) series.time_s.push_back(period_s * static_cast<double>(i));
  series.penetration.assign(rows, 0.0);
  series.velocity.assign(rows, 0.0);
  series.force.assign(rows, 0.0);
  return series;
}

TEST(ContactRows, AreThoseOfAForceWithItsMarginsAndShortGaps) {
  AxisSeries series = series_of(10000, 1e-3);
  const auto push = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) series.force[i] = 1.0;
  };
  push(2000, 3000);
  push(3400, 4000);  // gave way for 0.4 s
  push(6000, 7000);
  const std::size_t counted = mark_contact(series, 0.05);
  EXPECT_EQ(counted, static_cast<std::size_t>(std::reduce(series.counts.begin(), series.counts.end(), 0)));
  const auto counts = [&](std::size_t row) { return series.counts[row] != 0; };
  EXPECT_FALSE(counts(1890));
  EXPECT_TRUE(counts(1905) && counts(2500) && counts(3200) && counts(4090));
  EXPECT_FALSE(counts(4110) || counts(5000) || counts(5890) || counts(7110));
  EXPECT_TRUE(counts(5905) && counts(7090));
}

TEST(ContactRows, AreNotMadeByNoise) {
  AxisSeries series = series_of(10000, 1e-3);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.1);  // twice what a hand feels
  for (double& force : series.force) force = noise(random);
  for (std::size_t i = 5000; i < 6000; ++i) series.force[i] += 2.0;
  const std::size_t counted = mark_contact(series, 0.05);
  EXPECT_GE(counted, 1200U);
  EXPECT_LT(counted, 2500U) << "a row in 16,000 is beyond four standard deviations";
}

TEST(ContactRows, AreAllWhereNoForceIsFelt) {
  AxisSeries series = series_of(1000, 1e-3);
  EXPECT_EQ(mark_contact(series, 0.05), 1000U);
  EXPECT_TRUE(series.counts.empty());
}

/// What was recorded after a tool was put down, closed and with nothing in it.
schema::Recording with_a_tool_put_down(schema::Recording recording, std::size_t rows) {
  for (std::size_t i = 0; i < rows; ++i) {
    recording.time.push_back(recording.time.back() + 0.005);
    recording.tick.push_back(recording.tick.back() + 1);
    recording.position.push_back(0.38);
    recording.velocity.push_back(0.0);
    recording.force_measured.push_back(0.001 * (static_cast<double>(i % 3) - 1.0));
  }
  return recording;
}

TEST(ContactRows, KeepAToolThatWasPutDownFromDeciding) {  // finding L1
  const schema::Recording cut = test::cut_of(test::known_kelvin());
  const schema::Recording idle = with_a_tool_put_down(cut, 6 * cut.rows());
  const FitRecordingOptions options{.models = {"kelvin", "exponential"}};
  const RecordingFit with = fit_recording(idle, options);
  const RecordingFit without = fit_recording(cut, options);
  EXPECT_NEAR(with.jnd_n, without.jnd_n, 1e-3 * without.jnd_n);
  EXPECT_EQ(with.choice.model, "kelvin");
  EXPECT_NEAR(with.laws[0].result.held_out_rmse(), without.laws[0].result.held_out_rmse(), 2e-3);
  EXPECT_THAT(with.warnings, Contains(HasSubstr("rows are out of contact")));
  FitRecordingOptions all = options;
  all.rows = Counted::all;
  EXPECT_LT(fit_recording(idle, all).jnd_n, 0.5 * without.jnd_n) << "asked for, it decides";
}

TEST(RenderedSeries, IsAPeriodLate) {
  AxisSeries series = series_of(2000, 1e-3);
  for (std::size_t i = 0; i < 2000; ++i)
    series.penetration[i] = 0.01 * std::sin(5.0 * series.time_s[i]) + 0.02;
  const models::Law spring = models::Law::make("precontact", std::vector{300.0, 1e-6});
  const std::vector<double> at_once = render(spring, series);
  const std::vector<double> late = RenderedSeries(series, 1000.0).force(spring);
  for (std::size_t i = 1; i < 2000; ++i) EXPECT_NEAR(late[i], at_once[i - 1], 1e-9) << i;
}

TEST(RenderedSeries, HasTheVelocityOfALoop) {
  // Of a ramp from the second row on: v (1 - exp(-w (t - T))), w the corner of a driver's filter at 20 Hz.
  AxisSeries series = series_of(500, 1e-3);
  for (std::size_t i = 0; i < 500; ++i) series.penetration[i] = 0.1 * series.time_s[i];
  const models::Law damper = models::Law::make("friction", std::vector{0.0, 0.0, 40.0, 0.0, 1.0});
  const std::vector<double> force = RenderedSeries(series, 1000.0).force(damper);
  const double corner = 2.0 * std::numbers::pi * 20.0;
  for (std::size_t i = 2; i < 500; ++i) {
    const double since_s = 1e-3 * static_cast<double>(i - 1);
    EXPECT_NEAR(force[i], 40.0 * 0.1 * (1.0 - std::exp(-corner * since_s)), 1e-6) << i;
  }
}

TEST(RenderedSeries, OfAFewRowsASecondHasAFewTicksARow) {
  AxisSeries series = series_of(100, 0.5);
  for (std::size_t i = 0; i < 100; ++i) series.penetration[i] = 0.01 + 1e-4 * static_cast<double>(i);
  series.time_s[99] = 1e6;  // a week later: no ticks in between
  const models::Law spring = models::Law::make("precontact", std::vector{300.0, 1e-6});
  const std::vector<double> force = RenderedSeries(series, 1000.0).force(spring);
  ASSERT_EQ(force.size(), 100U);
  for (std::size_t i = 1; i < 99; ++i) EXPECT_NEAR(force[i], 300.0 * series.penetration[i], 0.01) << i;
}

}  // namespace
}  // namespace kerf::bench

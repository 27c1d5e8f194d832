#include <algorithm>
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
#include "fits/fit_recording.h"
#include "fits/rendered_series.h"
#include "fits/row_doubts.h"
#include "recordings/axis_series.h"

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
  all.rows.rows = Counted::all;
  EXPECT_LT(fit_recording(idle, all).jnd_n, 0.5 * without.jnd_n) << "asked for, it decides";
}

/// Strokes from penetration 0 to 20 mm and back, and the force at each place and way.
template <typename Force>
AxisSeries strokes_with(const Force& force) {
  AxisSeries series = series_of(8000, 1e-3);
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * series.time_s[i];
    series.penetration[i] = 0.01 * (1.0 - std::cos(phase));
    series.velocity[i] = 0.01 * 2.0 * std::numbers::pi * std::sin(phase);
    series.force[i] = force(series.penetration[i], series.velocity[i]);
  }
  return series;
}

TEST(RowDoubts, SayWhereTheForceBeginsIfNotAtContact) {
  const auto doubts = [](const auto& force) { return doubts_of(strokes_with(force), {.folds = 0}); };
  EXPECT_THAT(doubts([](double x, double) { return 200.0 * std::max(0.0, x - 0.01); }),
              testing::ElementsAre(HasSubstr("going in, the force begins at 50 % of the depth")));
  EXPECT_THAT(doubts([](double x, double) { return 1.0 + 200.0 * x; }),
              testing::ElementsAre(HasSubstr("a force of 1.02 N pushes already")));
  EXPECT_THAT(doubts([](double x, double) { return -1.0 - 200.0 * x; }),
              testing::ElementsAre(HasSubstr("--map 'force=COLUMN[-1 N]' turns it")));
  EXPECT_THAT(doubts([](double x, double) { return 200.0 * x; }), testing::IsEmpty());
  EXPECT_THAT(doubts([](double x, double) { return 2e-3 * std::expm1(400.0 * x); }), testing::IsEmpty())
      << "what stiffens begins gently";
  EXPECT_THAT(doubts([](double x, double v) { return 100.0 * x + std::copysign(0.8, v); }),
              testing::IsEmpty())
      << "friction turns with the motion";
}

// Tissue that has not come back since the stroke before is met later: the force sets in at a fifth of the way
// in from the second stroke on, and at its beginning in the first.
TEST(RowDoubts, SayNothingOfAContactThatTheFirstStrokeMeets) {
  AxisSeries series = strokes_with([](double, double) { return 0.0; });
  series.force = render(models::Law::make("kelvin", std::vector{200.0, 400.0, 160.0}), series);
  EXPECT_THAT(doubts_of(series, {.folds = 0}), testing::IsEmpty());
  series.force.erase(series.force.begin(), series.force.begin() + 1000);  // begins with the second
  series.force.insert(series.force.end(), series.force.end() - 1000, series.force.end());
  EXPECT_THAT(doubts_of(series, {.folds = 0}), Contains(HasSubstr("going in, the force begins at")));
}

TEST(RowDoubts, AskNobodyToTakeOutWhereTheMotionHasItsCorner) {
  AxisSeries series = series_of(30, 0.1);
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    series.penetration[i] = 0.01 * std::min(1.0, series.time_s[i]);
    series.velocity[i] = series.time_s[i] < 1.0 ? 0.01 : 0.0;
  }
  series.force = render(models::Law::make("kelvin", std::vector{200.0, 400.0, 40.0}), series);
  EXPECT_THAT(doubts_of(series, {.folds = 0}), testing::IsEmpty());
  series.force[20] += 3.0;
  EXPECT_THAT(doubts_of(series, {.folds = 0}), testing::ElementsAre(HasSubstr("one row stands out")));
}

TEST(RowDoubts, NameARowThatStandsOutWhereACoarseEncoderSteps) {
  constexpr double step_m = 0.25e-3;  // of 20 mm
  AxisSeries series = strokes_with([](double x, double) { return 200.0 * x; });
  for (double& depth : series.penetration) depth = step_m * std::round(depth / step_m);
  std::size_t row = 1200;
  while (series.penetration[row] == series.penetration[row + 1]) ++row;
  series.force[row] += 20.0;
  EXPECT_THAT(doubts_of(series, {.folds = 0}), Contains(HasSubstr("most of all at 1.203 s by 20 N")));
}

/// Without the rows of some seconds, from the first in which the tool goes in past a place after a time.
schema::Recording with_a_gap(schema::Recording recording, double after_s, double past, double gap_s) {
  std::size_t begin = 1;
  while (recording.time[begin] < after_s || recording.position[begin - 1] > past ||
         recording.position[begin] <= past)
    ++begin;
  std::size_t end = begin;
  while (recording.time[end] < recording.time[begin] + gap_s) ++end;
  const auto cut = [&](auto& values) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(begin),
                 values.begin() + static_cast<std::ptrdiff_t>(end));
  };
  cut(recording.time);
  cut(recording.tick);
  cut(recording.position);
  cut(recording.velocity);
  cut(recording.force_measured);
  return recording;
}

// What happened in a gap is known to nobody, and a law with a memory errs after it: judged by those rows too,
// the law that the tissue has is worse by half than its noise, and another one is taken.
TEST(RowDoubts, LeaveOutWhatTissueRemembersOfAGap) {
  const schema::Recording cut =
      with_a_gap(test::cut_of(test::known_kelvin(), {.with_cycles = false}), 3.0, 0.2, 0.5);
  FitRecordingOptions options{.models = {"kelvin", "friction", "exponential"}};
  const RecordingFit fit = fit_recording(cut, options);
  EXPECT_EQ(fit.choice.model, "kelvin");
  EXPECT_NEAR(fit.laws[0].result.rmse, 0.02, 1e-3);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("rows until the tool is free again count neither in fits")));
  options.rows.rows = Counted::all;
  const RecordingFit all = fit_recording(cut, options);
  EXPECT_GT(all.laws[0].result.rmse, 0.03);
  EXPECT_THAT(all.warnings, Contains(HasSubstr("errs for as long as it remembers")));
}

AxisSeries kelvin_strokes() {
  AxisSeries series = strokes_with([](double, double) { return 0.0; });
  series.force = render(models::Law::make("kelvin", std::vector{200.0, 400.0, 16.0}), series);
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (double& force : series.force) force += noise(random);
  return series;
}

TEST(RowDoubts, NameASensorThatWasNotZeroed) {
  EXPECT_THAT(doubts_of(kelvin_strokes(), {.folds = 0}), testing::IsEmpty());
  for (const double bias : {0.5, -0.5}) {
    AxisSeries series = kelvin_strokes();
    for (double& force : series.force) force += bias;
    EXPECT_THAT(doubts_of(series, {.folds = 0}),
                testing::ElementsAre(AllOf(HasSubstr(bias > 0.0 ? " pushes already" : " pulls already"),
                                           HasSubstr("as of a sensor that was not zeroed"))));
  }
}

// What is held and moved to both sides of its rest pulls as strongly as it pushes.
TEST(RowDoubts, TakeWhatIsHeldForNoSensorThatWasNotZeroed) {
  const AxisSeries series = strokes_with([](double x, double) { return 200.0 * (x - 0.009); });
  EXPECT_THAT(doubts_of(series, {.folds = 0}),
              testing::ElementsAre(AllOf(HasSubstr("a force of 1.78 N pulls already"),
                                         HasSubstr("moved to both sides of where it rests"))));
}

TEST(RowDoubts, NameASensorThatDrifts) {
  AxisSeries series = kelvin_strokes();
  for (std::size_t i = 0; i < series.force.size(); ++i) series.force[i] -= 0.08 * (series.time_s[i] - 4.0);
  EXPECT_THAT(doubts_of(series, {.folds = 0}),
              testing::ElementsAre(HasSubstr("the force went by -0.64 N from the first row to the last")));
}

TEST(RowDoubts, NameASensorThatIsClipped) {
  AxisSeries series = kelvin_strokes();
  for (double& force : series.force) force = std::min(force, 3.5);
  EXPECT_THAT(doubts_of(series, {.folds = 0}),
              testing::ElementsAre(
                  AllOf(HasSubstr("the force stands at 3.5 N in "), HasSubstr("its sensor is clipped"))));
  series.counts.assign(series.force.size(), 1);
  for (std::size_t i = 0; i < series.force.size(); ++i) series.counts[i] = series.force[i] < 3.5 ? 1 : 0;
  EXPECT_THAT(doubts_of(series, {.folds = 0}), testing::IsEmpty()) << "of rows that do not count";
}

// Loggers of relaxations write ten rows a second, then one, then one a minute.
TEST(RowDoubts, MissNoRowsInAHoldThatIsLoggedMoreAndMoreSparsely) {
  AxisSeries series;
  const auto log_until = [&](double end_s, double step_s) {
    for (double t = series.time_s.empty() ? 0.0 : series.time_s.back() + step_s; t < end_s; t += step_s)
      series.time_s.push_back(t);
  };
  log_until(2.0, 0.01);
  log_until(10.0, 0.1);
  log_until(100.0, 1.0);
  for (const double t : series.time_s) {
    series.penetration.push_back(0.01 * std::min(1.0, t));
    series.velocity.push_back(t < 1.0 ? 0.01 : 0.0);
  }
  series.force = render(models::Law::make("kelvin", std::vector{200.0, 400.0, 2000.0}), series);
  EXPECT_THAT(doubts_of(series, {.folds = 0}), testing::IsEmpty());
  // A hold of even rows lacks those of two seconds.
  for (std::size_t row = 150; row < series.time_s.size(); ++row) series.time_s[row] += 2.0;
  EXPECT_THAT(doubts_of(series, {.folds = 0}), Contains(HasSubstr("rows are missing once, for 2.01 s")));
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
  const std::vector<double> at_once = render(spring, series);
  constexpr double in_a_period = 300.0 * 1e-4 * 1e-3 / 0.5;
  for (std::size_t i = 1; i < 99; ++i) EXPECT_NEAR(force[i], at_once[i] - in_a_period, 1e-9) << i;
}

}  // namespace
}  // namespace kerf::bench

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/compare/agreement.h>
#include <kerf/compare/align.h>

#include "compare/runs.h"

namespace kerf::compare {
namespace {

using test::run_of;
using test::strokes;

/// A run with times from `begin` on, of a formula of the time less a lag.
Series timed(double begin_s, double period_s, std::size_t ticks, double lag_s,
             const std::function<double(double)>& force) {
  Series run{.channels = {{.name = "x", .unit = "N", .value = {}}}};
  for (std::size_t i = 0; i < ticks; ++i) {
    run.time_s.push_back(begin_s + period_s * static_cast<double>(i));
    run.channels[0].value.push_back(force(run.time_s.back() - lag_s));
  }
  return run;
}
double wave(double t) { return 2.0 + std::sin(7.0 * t) + 0.3 * std::sin(31.0 * t + 1.0); }

double apart(const Aligned& runs) {
  double most = 0.0;
  for (std::size_t i = 0; i < runs.expected.rows(); ++i)
    most = std::max(most, std::abs(runs.expected.channels[0].value[i] - runs.got.channels[0].value[i]));
  return most;
}

TEST(Align, ByTimePutsRunsOfDifferentRatesBesideEachOther) {
  const Aligned runs =
      aligned(timed(0.0, 1e-3, 4000, 0.0, wave), timed(0.5, 0.7e-3, 4000, 0.0, wave), {.by = AlignBy::time});
  EXPECT_EQ(runs.expected.rows(), 2800U);
  EXPECT_LT(apart(runs), 1e-3);
  EXPECT_EQ(runs.notes.size(), 1U);
  EXPECT_THROW((void)aligned(timed(0.0, 1e-3, 100, 0.0, wave), timed(9.0, 1e-3, 100, 0.0, wave),
                             {.by = AlignBy::time}),
               std::invalid_argument);
}

TEST(Align, ByTimeKeepsTheBitsOfRowsAtTheSameTimes) {
  const Series run = timed(0.0, 1e-3, 500, 0.0, wave);
  EXPECT_EQ(apart(aligned(run, run, {.by = AlignBy::time})), 0.0);
}

Series without_rows(Series run, std::size_t begin, std::size_t end) {
  for (std::vector<double>* column : {&run.time_s, &run.channels[0].value})
    column->erase(column->begin() + static_cast<std::ptrdiff_t>(begin),
                  column->begin() + static_cast<std::ptrdiff_t>(end));
  return run;
}

TEST(Align, ByTimeDrawsNoLineOverAGap) {
  const Series whole = timed(0.0, 1e-3, 4000, 0.0, wave);
  const Series part = without_rows(whole, 2000, 2300);
  for (const bool of_got : {true, false}) {
    const Aligned runs = aligned(of_got ? whole : part, of_got ? part : whole, {.by = AlignBy::time});
    EXPECT_EQ(runs.expected.rows(), 3700U);
    EXPECT_EQ(apart(runs), 0.0);
    ASSERT_EQ(runs.gaps.size(), 1U);
    EXPECT_EQ(runs.gaps[0].of_got, of_got);
    EXPECT_EQ(runs.gaps[0].rows, 300U);
    EXPECT_NEAR(runs.gaps[0].begin_s, 1.999, 1e-9);
    EXPECT_NEAR(runs.gaps[0].end_s, 2.3, 1e-9);
    EXPECT_THAT(runs.notes,
                testing::ElementsAre(testing::HasSubstr("300 rows of the other lie in there and are not")));
  }
  EXPECT_TRUE(aligned(part, part, {.by = AlignBy::time}).gaps.empty()) << "neither run has anything there";
}

TEST(Align, ByLagIsNotLedAstrayByAGap) {
  const Series late = without_rows(timed(0.0, 1e-3, 4000, 0.0137, wave), 2000, 2300);
  const Aligned runs = aligned(timed(0.0, 1e-3, 4000, 0.0, wave), late, {.by = AlignBy::lag});
  ASSERT_TRUE(runs.lag);
  EXPECT_NEAR(runs.lag->seconds, 0.0137, 1e-5);
  EXPECT_LT(apart(runs), 1e-3);
  ASSERT_EQ(runs.gaps.size(), 1U);
  EXPECT_EQ(runs.gaps[0].rows, 301U) << "from 1.986 to 2.286 s";
}

TEST(Agreement, FindsALatencyOfLessThanARowAcrossAGap) {
  const Series expected = without_rows(timed(0.0, 1e-3, 4000, 0.0, wave), 2000, 2300);
  const Series got = without_rows(timed(0.0, 1e-3, 4000, 0.0004, wave), 2000, 2300);
  EXPECT_NEAR(agreement(expected, got).at(0).latency_s.value(), 0.0004, 1e-6);
}

TEST(Align, ByLagKnowsOfNoneThatIsLongerThanWasLookedFor) {
  const Series expected = timed(0.0, 1e-3, 4000, 0.0, wave);
  const Series late = timed(0.0, 1e-3, 4000, 0.0137, wave);
  for (const double most_lag_s : {0.002, 0.005, 0.012}) {
    const Aligned runs = aligned(expected, late, {.by = AlignBy::lag, .most_lag_s = most_lag_s});
    EXPECT_FALSE(runs.lag);
    EXPECT_EQ(runs.no_lag_within_s, most_lag_s);
    EXPECT_EQ(runs.got.channels[0].value, late.channels[0].value) << "nothing is taken out";
    EXPECT_FALSE(agreement(expected, late, most_lag_s).at(0).latency_s);
  }
  for (const double lag_s : {0.005, -0.005, 0.0048}) {
    const Aligned runs =
        aligned(expected, timed(0.0, 1e-3, 4000, lag_s, wave), {.by = AlignBy::lag, .most_lag_s = 0.005});
    ASSERT_TRUE(runs.lag) << "as long as was looked for";
    EXPECT_NEAR(runs.lag->seconds, lag_s, 1e-5);
  }
}

// Half a period off they match as well, turned round.
TEST(Align, ByLagTakesStrokesThatRepeatForTurnedOnlyWhereTheyAre) {
  const auto stroke = [](double t) { return 1.0 + std::sin(2.0 * std::numbers::pi * t); };
  const Series expected = timed(0.0, 1e-3, 8000, 0.0, stroke);
  for (const double noise_n : {0.0, 0.01}) {
    for (const double lag_s : {0.05, 0.26, 0.3, 0.4, -0.3}) {
      Series got = timed(0.0, 1e-3, 8000, lag_s, stroke);
      const auto rough = test::noise(8000, noise_n, 7);
      for (std::size_t i = 0; i < rough.size(); ++i) got.channels[0].value[i] += rough[i];
      const Aligned runs = aligned(expected, got, {.by = AlignBy::lag});
      ASSERT_TRUE(runs.lag);
      EXPECT_NEAR(runs.lag->seconds, lag_s, 1e-3) << "with noise of " << noise_n << " N";
    }
  }
  const Series turned = timed(0.0, 1e-3, 4000, 0.0137, [](double t) { return -wave(t); });
  const Aligned runs = aligned(timed(0.0, 1e-3, 4000, 0.0, wave), turned, {.by = AlignBy::lag});
  ASSERT_TRUE(runs.lag);
  EXPECT_NEAR(runs.lag->seconds, 0.0137, 1e-4);
}

TEST(Align, ByLagSaysHowSureItIs) {
  int within = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Series got = timed(0.0, 1e-3, 4000, 0.01234, [](double t) { return 1.4 * wave(t) - 0.2; });
    const auto rough = test::noise(4000, 0.05, seed);
    for (std::size_t i = 0; i < rough.size(); ++i) got.channels[0].value[i] += rough[i];
    const Aligned runs = aligned(timed(0.0, 1e-3, 4000, 0.0, wave), got, {.by = AlignBy::lag});
    ASSERT_TRUE(runs.lag);
    // The slope of the wave times its gain has an RMS of 1.4 sqrt((7^2 + 9.3^2) / 2) N/s: by least squares.
    const double by_hand = 0.05 / (1.4 * std::sqrt((49.0 + 86.49) / 2.0)) / std::sqrt(4000.0);
    EXPECT_NEAR(runs.lag->std_error_s, by_hand, 0.25 * by_hand);
    within += std::abs(runs.lag->seconds - 0.01234) < 2.0 * runs.lag->std_error_s ? 1 : 0;
  }
  EXPECT_GE(within, 17) << "two standard errors hold 95 %";
}

TEST(Align, ByPositionComparesStrokesOfOtherSpeeds) {
  const auto stroke = [](double hz, std::size_t ticks) {
    Series run{.channels = {{.name = "x", .unit = "N", .value = {}}},
               .positions = {{.name = "x", .unit = "m", .value = {}}}};
    for (std::size_t i = 0; i < ticks; ++i) {
      const double x = 0.01 * (1.0 - std::cos(2.0 * std::numbers::pi * hz * 1e-3 * static_cast<double>(i)));
      run.positions[0].value.push_back(x);
      run.channels[0].value.push_back(std::exp(100.0 * x));
    }
    return run;
  };
  const Aligned runs = aligned(stroke(0.5, 4000), stroke(0.8, 2500), {.by = AlignBy::position});
  EXPECT_GT(runs.expected.rows(), 3500U);
  EXPECT_LT(apart(runs), 1e-3);
  EXPECT_THROW((void)aligned(stroke(0.5, 4000), stroke(1.6, 4000), {.by = AlignBy::position}),
               std::invalid_argument);
  EXPECT_THROW((void)aligned(run_of(strokes()), run_of(strokes()), {.by = AlignBy::position}),
               std::invalid_argument);
}

TEST(Align, KnowsItsNames) {
  EXPECT_EQ(align_by("position"), AlignBy::position);
  EXPECT_THROW((void)align_by("feeling"), std::invalid_argument);
}

TEST(Agreement, FindsGainOffsetLatencyAndCoherence) {
  const Series expected = timed(0.0, 1e-3, 8000, 0.0, wave);
  Series got = timed(0.0, 1e-3, 8000, 0.0035, [](double t) { return 0.8 * wave(t) + 0.1; });
  const auto rough = test::noise(8000, 0.2);
  for (std::size_t i = 0; i < rough.size(); ++i) got.channels[0].value[i] += rough[i];
  const ChannelAgreement channel = agreement(expected, got).at(0);
  EXPECT_NEAR(channel.gain, 0.8, 0.02);
  EXPECT_NEAR(channel.offset, 0.1, 0.04);
  EXPECT_NEAR(channel.latency_s.value(), 0.0035, 3.0 * channel.latency_std_error_s + 1e-4);
  ASSERT_GE(channel.coherence.size(), 6U);
  // At 31 rad/s, in windows of a second: 0.24^2 / 2 of the wave, in three bins, and noise of 0.2^2 / 512 in
  // each.
  EXPECT_GT(channel.coherence[0].coherence, 0.95) << "the wave is there";
  EXPECT_LT(channel.coherence[5].coherence, 0.3) << "noise alone";
}

// Between two rows a straight line averages their noise: half a tick of lag would look like a better fit.
TEST(Agreement, FindsNoLatencyInTheNoiseOfTwoSensors) {
  int beyond = 0;
  double sum = 0.0;
  constexpr int pairs = 40;
  for (unsigned pair = 0; pair < pairs; ++pair) {
    Series expected = timed(0.0, 2e-3, 4000, 0.0, wave);
    Series got = timed(0.0, 2e-3, 4000, 0.0, wave);
    const auto one = test::noise(4000, 0.02, 2 * pair + 1);
    const auto other = test::noise(4000, 0.02, 2 * pair + 2);
    for (std::size_t i = 0; i < one.size(); ++i) {
      expected.channels[0].value[i] += one[i];
      got.channels[0].value[i] += other[i];
    }
    const ChannelAgreement channel = agreement(expected, got).at(0);
    const double errors = channel.latency_s.value() / channel.latency_std_error_s;
    sum += errors;
    beyond += std::abs(errors) > 2.0 ? 1 : 0;
  }
  EXPECT_LE(beyond, 7) << "of 40, of which 2 are expected";
  EXPECT_LT(std::abs(sum) / pairs, 0.6) << "nor a lag on the whole";
}

// Of a slow wave noise moves the least difference by ticks: the lag lies beyond the whole shift beside it.
TEST(Align, FindsALagBetweenTicksUnderNoise) {
  const auto slow = [](double t) { return 1.2 * (1.0 - std::cos(3.141592653589793 * t)); };
  for (const double lag_s : {0.0053, 0.0137}) {
    int beyond = 0;
    int whole = 0;
    constexpr int pairs = 20;
    for (unsigned pair = 0; pair < pairs; ++pair) {
      Series expected = timed(0.0, 1e-3, 6000, 0.0, slow);
      Series got = timed(0.0, 1e-3, 6000, lag_s, slow);
      const auto one = test::noise(6000, 0.02, 2 * pair + 1);
      const auto other = test::noise(6000, 0.02, 2 * pair + 2);
      for (std::size_t i = 0; i < one.size(); ++i) {
        expected.channels[0].value[i] += one[i];
        got.channels[0].value[i] += other[i];
      }
      const Lag lag = lag_between_runs(expected, got, 0.5).value();
      beyond += std::abs(lag.seconds - lag_s) > 2.0 * lag.std_error_s ? 1 : 0;
      whole += std::abs(lag.ticks - std::round(lag.ticks)) < 1e-6 ? 1 : 0;
    }
    EXPECT_LE(beyond, 4) << "of 20, of which 1 is expected";
    EXPECT_EQ(whole, 0);
  }
}

}  // namespace
}  // namespace kerf::compare

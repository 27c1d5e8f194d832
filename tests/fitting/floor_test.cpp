#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/fitting/checked_recordings.h>

#include "strokes.h"

namespace kerf::fitting {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Strokes of 0.4, each with a speed and a gain of its own.
struct Cycles {
  std::vector<double> time_s, penetration, velocity, force;
  std::vector<std::uint32_t> cycle;

  template <typename Force>
  Cycles(std::size_t count, double speed_spread, double gain_spread, double noise_n, Force&& of) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (std::uint32_t number = 1; number <= count; ++number) {
      const double rate = 4.0 * std::exp(speed_spread * normal(random));  // [rad/s]
      const double gain = 1.0 + gain_spread * normal(random);
      const auto rows = static_cast<std::size_t>(2.0 * M_PI / rate / 1e-3);
      for (std::size_t i = 0; i < rows; ++i) {
        const double phase = rate * 1e-3 * static_cast<double>(i);
        time_s.push_back(1e-3 * static_cast<double>(time_s.size()));
        penetration.push_back(0.2 * (1.0 - std::cos(phase)));
        velocity.push_back(0.2 * rate * std::sin(phase));
        force.push_back(gain * of(penetration.back(), velocity.back()) + noise_n * normal(random));
        cycle.push_back(number);
      }
    }
  }

  [[nodiscard]] Series series() const {
    return {
        .time_s = time_s, .penetration = penetration, .velocity = velocity, .force = force, .cycle = cycle};
  }
  [[nodiscard]] Floor floor() const {
    const Series all = series();
    return floor_of(std::span(&all, 1), {});
  }
};

double spring(double x, double) { return 10.0 * x + 30.0 * x * x; }
double loop(double x, double v) { return spring(x, v) * (v < 0.0 ? 0.5 : 1.0); }
double damper(double x, double v) { return 10.0 * x + 1.5 * v; }

TEST(Floor, OfAFunctionOfPositionAndDirectionIsTheNoise) {
  for (const auto& law : {spring, loop}) {
    const Floor floor = Cycles(20, 0.3, 0.0, 0.05, law).floor();
    EXPECT_NEAR(floor.position_n, 0.05, 0.002);
    EXPECT_NEAR(floor.velocity_n, 0.05, 0.002);
    EXPECT_NEAR(floor.unlimited_n, 0.05, 0.002);
    EXPECT_NEAR(floor.noise_n, 0.05, 0.002);
    EXPECT_EQ(floor.quantum_n, 0.0);
    EXPECT_TRUE(floor.by_cycle);
  }
}

// Checked once, and fitted one law after the other, one of them in sizes that it keeps.
TEST(CheckedRecordings, GiveTheFitsAndTheFloorOfTheirSeries) {
  const Cycles cycles(4, 0.3, 0.1, 0.05, damper);
  const Series series = cycles.series();
  const FitOptions options{.folds = 3};
  const CheckedRecordings checked(std::span(&series, 1), options);
  for (const char* const model : {"maxwell", "kelvin", "maxwell"}) {
    const FitResult alone = fit(model, series, options);
    const FitResult shared = fit(model, checked, options);
    EXPECT_EQ(shared.rmse, alone.rmse) << model;
    EXPECT_EQ(shared.cv_folds, alone.cv_folds) << model;
    ASSERT_EQ(shared.parameters.size(), alone.parameters.size()) << model;
    for (std::size_t i = 0; i < alone.parameters.size(); ++i) {
      EXPECT_EQ(shared.parameters[i].value, alone.parameters[i].value) << model;
      EXPECT_EQ(shared.parameters[i].lower, alone.parameters[i].lower) << model;
    }
  }
  EXPECT_EQ(floor_of(checked).velocity_n, floor_of(std::span(&series, 1), options).velocity_n);
}

TEST(Floor, OfADamperMovedAtManySpeedsNeedsTheVelocity) {
  const Floor floor = Cycles(20, 0.3, 0.0, 0.02, damper).floor();
  EXPECT_GT(floor.position_n, 0.1) << "cycles differ by their speeds";
  EXPECT_LT(floor.velocity_n, 0.5 * floor.position_n);
  const std::string words = blame(floor.position_n, floor.position_n, floor, 0.05);
  EXPECT_THAT(words, HasSubstr("the hand, whose speed changes is most to blame"));
}

TEST(Floor, IsNotSaidToLieAboveWhatALoopReached) {
  const Floor floor = Cycles(20, 0.3, 0.0, 0.02, damper).floor();
  const double reached = 0.8 * floor.velocity_n;
  EXPECT_THAT(blame(reached, floor.position_n, floor, 0.5 * reached), HasSubstr("of 2 JND"))
      << "the error itself";
  EXPECT_THAT(blame(reached, floor.position_n, floor, 0.5 * reached),
              HasSubstr("nothing that was tried errs by less than 2 JND"));
}

TEST(Floor, OfCyclesThatDifferIsTheirSpread) {
  const Cycles cycles(40, 0.0, 0.2, 0.02, spring);
  const Floor floor = cycles.floor();
  double squares = 0.0;  // of the force at a gain of 1
  for (const double x : cycles.penetration) squares += std::pow(spring(x, 0.0), 2);
  const double rms = std::sqrt(squares / static_cast<double>(cycles.penetration.size()));
  EXPECT_NEAR(floor.position_n, 0.2 * rms, 0.04 * rms)
      << "a standard deviation by 40 cycles is known to 11 %";
  EXPECT_THAT(blame(floor.position_n, floor.position_n, floor, 0.05),
              HasSubstr("the spread from cycle to cycle is most to blame"));
}

TEST(Floor, OfTissueThatRemembersIsNoSpread) {
  // A slow branch beside the spring, held: at one position and speed the force goes on falling.
  Cycles cycles(0, 0.0, 0.0, 0.0, spring);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 0.02);
  double slow = 0.0;
  for (std::uint32_t number = 1; number <= 20; ++number) {
    for (int i = 0; i < 2000; ++i) {
      const double velocity = i < 300 ? 0.4 / 0.3 : i >= 1300 && i < 1600 ? -0.4 / 0.3 : 0.0;
      const double before = cycles.penetration.empty() ? 0.0 : cycles.penetration.back();
      cycles.time_s.push_back(1e-3 * static_cast<double>(cycles.time_s.size()));
      cycles.penetration.push_back(std::max(0.0, before + 1e-3 * velocity));
      cycles.velocity.push_back(velocity);
      slow += 1e-3 * (40.0 * velocity - slow / 0.4);
      cycles.force.push_back(spring(cycles.penetration.back(), velocity) + slow + normal(random));
      cycles.cycle.push_back(number);
    }
  }
  const Floor floor = cycles.floor();
  ASSERT_GT(floor.velocity_n, 0.1) << "the maps do not know it";
  EXPECT_GT(floor.memory_n, 0.5 * floor.velocity_n);
  const Floor spread = Cycles(40, 0.0, 0.2, 0.02, spring).floor();
  EXPECT_LT(spread.memory_n, 0.3 * spread.velocity_n);
}

TEST(Floor, OfASensorInStepsKnowsTheStep) {
  Cycles cycles(10, 0.0, 0.0, 0.0, spring);
  for (double& force : cycles.force) force = 0.25 * std::round(force / 0.25);
  const Floor floor = cycles.floor();
  EXPECT_DOUBLE_EQ(floor.quantum_n, 0.25);
  EXPECT_NEAR(floor.noise_n, 0.25 / std::sqrt(12.0), 1e-12) << "steps are rounded, so uniform";
}

TEST(Floor, GoesByTheSamplesThatCount) {
  Cycles cycles(10, 0.3, 0.0, 0.05, spring);
  std::vector<std::uint8_t> counts(cycles.force.size(), 1);
  for (std::size_t i = 0; i < counts.size(); i += 3) {
    counts[i] = 0;
    cycles.force[i] = -100.0;
  }
  const Series series{.time_s = cycles.time_s,
                      .penetration = cycles.penetration,
                      .velocity = cycles.velocity,
                      .force = cycles.force,
                      .cycle = cycles.cycle,
                      .noise_n = 0.05,
                      .counts = counts};
  EXPECT_NEAR(floor_of(std::span(&series, 1), {}).position_n, 0.05, 0.002);
}

TEST(Floor, IsNoHigherThanALawThatGoesOnWhereNoMapHasSeenAnything) {
  Floor floor{.position_n = 0.5, .velocity_n = 0.4, .unlimited_n = 0.3, .folds = 5};
  floor.lower_to(0.35);
  EXPECT_EQ(floor.position_n, 0.35);
  EXPECT_EQ(floor.velocity_n, 0.35);
  EXPECT_EQ(floor.unlimited_n, 0.3);
  floor.lower_to(std::nan(""));
  EXPECT_EQ(floor.position_n, 0.35) << "a law that was not held out";
}

TEST(ErrorParts, HaveSquaresThatAddUp) {
  const Floor floor{
      .position_n = 0.5, .velocity_n = 0.4, .unlimited_n = 0.3, .noise_n = 0.1, .by_cycle = true, .folds = 5};
  const ErrorParts parts = parts_of(0.7, 0.6, floor);
  EXPECT_NEAR(parts.loop, std::sqrt(0.49 - 0.36), 1e-12);
  EXPECT_NEAR(parts.law, std::sqrt(0.36 - 0.25), 1e-12);
  EXPECT_NEAR(parts.hand, std::sqrt(0.25 - 0.16), 1e-12);
  EXPECT_NEAR(parts.data, std::sqrt(0.16 - 0.09), 1e-12);
  EXPECT_NEAR(parts.spread, std::sqrt(0.09 - 0.01), 1e-12);
  EXPECT_NEAR(parts.sensor, 0.1, 1e-12);
  // A memory foretells more than any map: nothing is left for law, hand and too little data.
  const ErrorParts better = parts_of(0.2, 0.2, floor);
  EXPECT_EQ(better.law + better.hand + better.data, 0.0);
  EXPECT_NEAR(better.spread, std::sqrt(0.04 - 0.01), 1e-12);
  Floor remembers = floor;
  remembers.memory_n = 0.35;
  const ErrorParts known = parts_of(0.7, 0.6, remembers);
  EXPECT_NEAR(known.memory, 0.35, 1e-12);
  EXPECT_NEAR(std::pow(known.data, 2) + std::pow(known.spread, 2), 0.16 - 0.1225 - 0.01, 1e-12);
  EXPECT_NEAR(parts_of(0.2, 0.2, remembers).memory, std::sqrt(0.1225 - 0.16 + 0.04), 1e-12)
      << "most is known";
  EXPECT_THAT(blame(0.7, 0.6, remembers, 0.01),
              HasSubstr("a memory, which neither position nor speed tells"));
  EXPECT_EQ(blame(0.7, 0.6, floor, 0.7), "") << "nobody feels it";
  EXPECT_THAT(blame(0.7, 0.6, floor, 0.1), StartsWith("of 7 JND, the loop's filter and latency"));
  EXPECT_EQ(blame(0.7, 0.6, {}, 0.1), "") << "nothing was held out";
}

TEST(Fit, RunsThroughSamplesThatDoNotCount) {
  const models::Law kelvin = models::Law::make("kelvin", std::vector{20.0, 50.0, 5.0});
  test::Strokes strokes(6000, 0.0, kelvin);
  std::vector<std::uint8_t> counts(strokes.force.size(), 1);
  for (std::size_t i = 2000; i < 2500; ++i) {
    counts[i] = 0;
    strokes.force[i] = 1e3;
  }
  Series series = strokes.series();
  series.counts = counts;
  const FitResult result = fit("kelvin", series);
  EXPECT_NEAR(result.parameters[1].value, 50.0, 1e-4);
  EXPECT_LT(result.cv_rmse, 1e-5);
  EXPECT_LT(result.max_abs, 1e-5);
  EXPECT_EQ(result.samples, 5500U);
  EXPECT_LT(rms_of(series), 20.0);
  EXPECT_LT(line_rmse(series), 20.0);
}

TEST(Fit, IsJudgedAsItIsRendered) {
  const models::Law spring_law = models::Law::make("precontact", std::vector{30.0, 1e-6});
  const test::Strokes strokes(6000, 0.0, spring_law);
  FitOptions options;
  options.render = [&](const models::Law& law, std::size_t) {
    std::vector<double> late = strokes.force;  // half a newton too little, whatever the law
    for (double& force : late) force -= 0.5;
    (void)law;
    return late;
  };
  const FitResult result = fit("kelvin", strokes.series(true), options);
  EXPECT_LT(result.cv_rmse, 1e-3);
  EXPECT_NEAR(result.rendered.rmse, 0.5, 1e-12);
  EXPECT_NEAR(result.rendered.cv_rmse, 0.5, 1e-12);
  EXPECT_EQ(result.held_out_rmse(), result.rendered.cv_rmse);
  const std::vector results{result};
  EXPECT_THAT(choose_simplest(results, strokes.series(true), options).why,
              HasSubstr("error on held-out data as rendered (0.5 N) stays within the JND"))
      << "the sentence names the number that the column of that name has";
  const FitResult fitted = fit("kelvin", strokes.series(true));
  EXPECT_THAT(choose_simplest(std::vector{fitted}, strokes.series(true), {}).why,
              HasSubstr("error on held-out data ("));
}

/// Strokes of one cycle each, of the forces of one stroke.
struct OneStrokeEach {
  Cycles strokes{0, 0.0, 0.0, 0.0, spring};

  explicit OneStrokeEach(const std::vector<std::function<double(double)>>& forces) {
    constexpr std::size_t rows = 200;
    std::uint32_t number = 0;
    for (const auto& force : forces) {
      ++number;
      for (std::size_t i = 0; i < rows; ++i) {
        const double phase = 2.0 * M_PI * static_cast<double>(i) / rows;
        strokes.time_s.push_back(1e-3 * static_cast<double>(strokes.time_s.size()));
        strokes.penetration.push_back(0.2 * (1.0 - std::cos(phase)));
        strokes.velocity.push_back(40.0 * M_PI / rows * std::sin(phase));
        strokes.force.push_back(force(strokes.penetration.back()));
        strokes.cycle.push_back(number);
      }
    }
  }

  [[nodiscard]] double held_out(std::size_t folds, double test_share = 0.0) const {
    const Series series = strokes.series();
    return held_out_line_rmse(
        CheckedRecordings(std::span(&series, 1), {.folds = folds, .test_share = test_share}));
  }
};

// numpy.polyfit on the other strokes, numpy.polyval on each.
TEST(Line, HeldOutIsNumPysOfTheOtherCycles) {
  const auto first = [](double x) { return 10.0 * x + 30.0 * x * x; };
  const auto second = [](double x) { return 12.0 * x + 20.0 * x * x + 0.1; };
  const auto third = [](double x) { return 11.0 * x - 0.05; };
  EXPECT_NEAR(OneStrokeEach({first, second}).held_out(2), 0.4690415759823427, 1e-12);
  const OneStrokeEach three({first, second, third});
  EXPECT_NEAR(three.held_out(3), 1.5493278112351414, 1e-12);
  EXPECT_NEAR(three.held_out(2, 0.4), 0.4690415759823427, 1e-12)
      << "what no fit sees, a line does not either";
}

TEST(Line, WithoutFoldsIsNotHeldOut) {
  EXPECT_TRUE(std::isnan(OneStrokeEach({[](double x) { return x; }}).held_out(0)));
}

}  // namespace
}  // namespace kerf::fitting

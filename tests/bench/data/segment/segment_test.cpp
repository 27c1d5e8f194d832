#include "segment/segment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::HasSubstr;

/// Scissors that open and close by cosines, with pauses: 1 N more while closing, on a spring of 2 N/rad.
struct Cutting {
  double direction = 1.0;  ///< of closing
  int strokes = 8;         ///< closings and openings together, a closing first
  double stroke_s = 0.5;
  double pause_s = 0.2;
  double noise = 0.0;  ///< of position and force, as a share of their range

  [[nodiscard]] schema::Recording recording() const {
    schema::Recording recording;
    recording.axes = {{.name = "theta", .position_unit = "rad"}};
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;  // its deviation must not be 0
    const double cycle_s = stroke_s + pause_s;
    const auto rows = static_cast<int>(std::lround((strokes * cycle_s + pause_s) * 1000.0));
    for (int row = 0; row < rows; ++row) {
      const double t = 1e-3 * row - pause_s;
      const int stroke = std::clamp(static_cast<int>(std::floor(t / cycle_s)), 0, strokes - 1);
      const double phase = std::clamp((t - stroke * cycle_s) / stroke_s, 0.0, 1.0);
      const double share = 0.5 * (1.0 - std::cos(std::numbers::pi * phase));
      const bool closing = stroke % 2 == 0;
      const double closed = closing ? share : 1.0 - share;
      const bool moving = phase > 0.0 && phase < 1.0;
      recording.time.push_back(1e-3 * row);
      recording.position.push_back(direction * 0.5 * closed + noise * normal(random) * 0.5);
      recording.force_measured.push_back(closed + (closing && moving ? 1.0 : 0.0) +
                                         noise * normal(random) * 2.0);
    }
    return recording;
  }
};

long count(const schema::Cycles& cycles, schema::Phase phase) {
  return std::count_if(cycles.phases.begin(), cycles.phases.end(),
                       [&](const auto& span) { return span.phase == phase; });
}

TEST(Segment, FindsNoCyclesInTheNoiseOfATool) {
  schema::Recording recording = Cutting{}.recording();
  std::mt19937_64 random(8);
  std::normal_distribution<double> noise(0.0, 1e-6);
  for (double& position : recording.position) position = 0.005 + noise(random);
  try {
    (void)find_cycles(recording, {});
    FAIL() << "cycles were found";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("turns by no more than its noise does"));
  }
}

TEST(Segment, FindsEveryCycleWithItsFourPhasesInOrder) {
  const auto cycles = find_cycles(Cutting{}.recording(), {});
  EXPECT_EQ(count(cycles, schema::Phase::closing), 4);
  EXPECT_EQ(count(cycles, schema::Phase::opening), 4);
  EXPECT_EQ(count(cycles, schema::Phase::open_to_close), 4);
  EXPECT_EQ(count(cycles, schema::Phase::close_to_open), 4);
  EXPECT_EQ(cycles.closing_direction, 1.0);
  EXPECT_NEAR(cycles.contact_position, 0.0, 1e-3);
  for (std::size_t i = 1; i < cycles.phases.size(); ++i) {
    EXPECT_EQ(cycles.phases[i].begin, cycles.phases[i - 1].end) << "phases follow each other without a gap";
    EXPECT_LE(cycles.phases[i - 1].cycle, cycles.phases[i].cycle);
  }
}

// The low-pass cuts a corner off by 0.1 mm of 10; where the least row of each is, tissue begins.
TEST(Segment, PutsTheContactWherePathsOfStraightLinesTurn) {
  for (const double direction : {1.0, -1.0}) {
    for (const double noise_m : {0.0, 1e-5}) {
      schema::Recording recording;
      recording.axes = {{.name = "x", .position_unit = "m"}};
      std::mt19937_64 random(3);
      std::normal_distribution<double> normal;
      for (int row = 0; row < 5000; ++row) {
        const double t = 0.002 * row;
        const double depth = 0.01 * (1.0 - std::abs(2.0 * (t - std::floor(t)) - 1.0));
        recording.time.push_back(t);
        recording.position.push_back(direction * (0.03 + depth + noise_m * normal(random)));
        recording.force_measured.push_back(200.0 * depth);
      }
      EXPECT_NEAR(find_cycles(recording, {}).contact_position, direction * 0.03, 2.0 * noise_m + 1e-9);
    }
  }
}

// The least of many noisy rows lies well below where a round turn does.
TEST(Segment, PutsTheContactIntoTheMiddleOfTheNoiseOfARoundTurn) {
  EXPECT_NEAR(find_cycles(Cutting{.noise = 0.02}.recording(), {}).contact_position, 0.0, 0.01);
}

TEST(Segment, TakesForClosingTheWayThatCostsMore) {
  const auto cycles = find_cycles(Cutting{.direction = -1.0}.recording(), {});
  EXPECT_EQ(cycles.closing_direction, -1.0);
  EXPECT_EQ(count(cycles, schema::Phase::closing), 4);
  EXPECT_LT(cycles.grid.front(), cycles.grid.back()) << "the grid increases whichever direction closing has";
  const auto told = find_cycles(Cutting{.direction = -1.0}.recording(), {.closing_direction = 1.0});
  EXPECT_EQ(told.closing_direction, 1.0);
}

// A spring costs as much on the way in as it gives back: noise would decide.
TEST(Segment, OfASpringTakesForClosingTheWayIntoIt) {
  for (const double direction : {1.0, -1.0}) {
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
      schema::Recording recording = Cutting{.direction = direction}.recording();
      std::mt19937_64 random(seed);
      std::normal_distribution<double> noise(0.0, 0.5);
      for (std::size_t row = 0; row < recording.position.size(); ++row)
        recording.force_measured[row] = 4.0 * std::abs(recording.position[row]) + noise(random);
      EXPECT_EQ(find_cycles(recording, {}).closing_direction, direction) << seed;
    }
  }
}

// A command has the sign of the axis and pushes out of the tissue, of a spring with as much force either way.
TEST(Segment, TakesForClosingTheWayAgainstACommand) {
  for (const double direction : {1.0, -1.0}) {
    for (const bool only_a_spring : {false, true}) {
      schema::Recording recording = Cutting{.direction = direction}.recording();
      for (std::size_t row = 0; row < recording.position.size(); ++row) {
        const double resists =
            only_a_spring ? 4.0 * std::abs(recording.position[row]) : recording.force_measured[row];
        recording.force_commanded.push_back(-direction * resists);
      }
      recording.force_measured.clear();
      EXPECT_EQ(find_cycles(recording, {}).closing_direction, direction) << only_a_spring;
    }
  }
}

TEST(Segment, CountsStrokesAndNotNoise) {
  const auto cycles = find_cycles(Cutting{.noise = 0.02}.recording(), {});
  EXPECT_EQ(count(cycles, schema::Phase::closing), 4);
  EXPECT_EQ(count(cycles, schema::Phase::opening), 4);
}

TEST(Segment, KeepsAClosingThatNeverOpens) {
  const auto cycles = find_cycles(Cutting{.strokes = 5}.recording(), {});
  EXPECT_EQ(count(cycles, schema::Phase::closing), 3);
  EXPECT_EQ(count(cycles, schema::Phase::opening), 2);
  ASSERT_EQ(cycles.opening.size(), 3U);
  EXPECT_TRUE(std::isnan(cycles.opening[2][50]));
}

TEST(Segment, AveragesTheBranchesOnTheGrid) {
  const auto cycles = find_cycles(Cutting{.noise = 0.01}.recording(), {.corner_hz = 40.0});
  for (std::size_t i = 20; i < 80; ++i) {
    const double closed = cycles.grid[i] / 0.5;
    EXPECT_NEAR(cycles.closing_mean[i], closed + 1.0, 0.03) << "at " << cycles.grid[i];
    EXPECT_NEAR(cycles.opening_mean[i], closed, 0.03) << "at " << cycles.grid[i];
  }
}

TEST(Segment, GivesTheFirstPlaceOfACoarseGridTheRowsNearestToIt) {
  const auto cycles = find_cycles(Cutting{}.recording(), {.dwell = 0.02, .points = 11});
  // Rows from 2 %, where the stroke begins, to 5 %, halfway to the next place.
  EXPECT_NEAR(cycles.closing_mean.front(), 1.035, 0.015);
  EXPECT_NEAR(cycles.opening_mean.front(), 0.035, 0.015);
}

TEST(Segment, StartsInTheMiddleOfAnOpening) {
  schema::Recording recording = Cutting{}.recording();
  const std::ptrdiff_t cut = 1150;  // within the first opening
  recording.time.erase(recording.time.begin(), recording.time.begin() + cut);
  recording.position.erase(recording.position.begin(), recording.position.begin() + cut);
  recording.force_measured.erase(recording.force_measured.begin(), recording.force_measured.begin() + cut);
  const auto cycles = find_cycles(recording, {});
  EXPECT_EQ(count(cycles, schema::Phase::closing), 3);
  EXPECT_EQ(cycles.phases.front().phase, schema::Phase::open_to_close) << "that opening belongs to no cycle";
}

TEST(Segment, RefusesTimesThatGoBack) {
  schema::Recording recording = Cutting{}.recording();
  recording.time[100] = recording.time[98];
  EXPECT_THROW((void)find_cycles(recording, {}), std::invalid_argument);
}

TEST(Segment, RefusesWhatHasNoCycles) {
  const auto refusal = [](const schema::Recording& recording) -> std::string {
    try {
      (void)find_cycles(recording, {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal(Cutting{.strokes = 1}.recording()), HasSubstr("no cycle of opening and closing"));
  schema::Recording still = Cutting{}.recording();
  std::fill(still.position.begin(), still.position.end(), 0.3);
  EXPECT_THAT(refusal(still), HasSubstr("no cycle"));
  schema::Recording gap = Cutting{}.recording();
  gap.force_measured[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(gap), HasSubstr("row 7 is not finite; 'kerf prepare --drop-gaps'"));
  schema::Recording forceless = Cutting{}.recording();
  forceless.force_measured.clear();
  EXPECT_THAT(refusal(forceless), HasSubstr("no force"));
}

}  // namespace
}  // namespace kerf::bench

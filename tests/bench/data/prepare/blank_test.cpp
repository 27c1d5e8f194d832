#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prepare/prepare.h"
#include "segment/segment.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double period_s = 4e-3;

struct Tool {
  double friction = 0.3;   ///< [N], against the motion
  double slope = 1.0;      ///< of it along the way [N/rad]
  double inertia = 0.0;    ///< [N s^2/rad]
  double stiffness = 0.0;  ///< of a tissue from 0.2 rad on [N/rad]
  double reach = 0.5;      ///< [rad]
  double stroke_s = 0.4;
  double direction = 1.0;  ///< in which it closes
  double spread = 0.0;     ///< from cycle to cycle [N]
  unsigned seed = 1;
};

/// Ten cycles at 250 Hz, each a wait, a closing, a hold and an opening; each cycle takes a little longer or
/// shorter than the next, or inertia could not be told from position. The force resists closing.
schema::Recording cut(const Tool& tool) {
  std::mt19937_64 random(tool.seed);
  std::normal_distribution<double> normal;
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  const auto add = [&](double x, double v, double a, double extra) {
    const double sign = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
    const double f = sign * (tool.friction + tool.slope * x) + tool.inertia * a + extra +
                     tool.stiffness * std::max(0.0, x - 0.2) + 0.002 * normal(random);
    recording.time.push_back(period_s * static_cast<double>(recording.time.size()));
    recording.tick.push_back(recording.time.size() - 1);
    recording.position.push_back(tool.direction * x);
    recording.velocity.push_back(tool.direction * v);
    recording.force_measured.push_back(f);
  };
  for (int cycle = 0; cycle < 10; ++cycle) {
    const double extra = tool.spread * normal(random);
    const double stroke_s = tool.stroke_s * (1.0 + 0.3 * std::sin(2.0 * cycle));
    const auto wait = [&](double x) {
      for (int i = 0; i < 50; ++i) add(x, 0.0, 0.0, 0.0);
    };
    const auto stroke = [&](bool closing) {
      const auto rows = static_cast<int>(stroke_s / period_s);
      for (int i = 0; i < rows; ++i) {
        const double w = std::numbers::pi / stroke_s;
        const double phase = w * period_s * (i + 0.5);
        const double x = 0.5 * tool.reach * (1.0 - std::cos(phase));
        const double v = 0.5 * tool.reach * w * std::sin(phase);
        const double a = 0.5 * tool.reach * w * w * std::cos(phase);
        closing ? add(x, v, a, extra) : add(tool.reach - x, -v, -a, -extra);
      }
    };
    wait(0.0);
    stroke(true);
    wait(tool.reach);
    stroke(false);
  }
  recording.cycles = find_cycles(recording, {});
  return recording;
}

BlankOptions blank_of(const Tool& tool) {
  return {.recording = cut(tool), .file = "blank.h5", .sha256 = "00ff"};
}

/// Rows of the strokes of one direction.
std::vector<std::size_t> rows_of(const schema::Recording& recording, schema::Phase phase) {
  std::vector<std::size_t> rows;
  for (const schema::PhaseSpan& span : recording.cycles->phases) {
    for (std::size_t row = span.begin; row < span.end && span.phase == phase; ++row) rows.push_back(row);
  }
  return rows;
}

TEST(Blank, LeavesOfACutWhatTheTissueDid) {
  const Tool tissue{.stiffness = 8.0, .spread = 0.02, .seed = 2};
  const Prepared prepared = prepare(cut(tissue), {.blank = blank_of({.spread = 0.02})});
  const BlankTaken& taken = *prepared.blank;
  ASSERT_GT(taken.tool.used.size(), 6U);
  for (const schema::Phase phase : {schema::Phase::closing, schema::Phase::opening}) {
    double error = 0.0;
    double largest = 0.0;
    const auto rows = rows_of(prepared.recording, phase);
    for (const std::size_t row : rows) {
      const double x = prepared.recording.position[row];
      const double off = prepared.recording.force_measured[row] - 8.0 * std::max(0.0, x - 0.2);
      error += off / static_cast<double>(rows.size());
      largest = std::max(largest, std::abs(off));
    }
    // The mean of ten cycles of the blank and ten of the cut, each with a spread of 0.02 N.
    EXPECT_LT(std::abs(error), 3.0 * 0.02 * std::sqrt(0.2));
    EXPECT_LT(largest, 0.09);
  }
  EXPECT_NEAR(taken.spread_rms, 0.02, 0.01);
  EXPECT_GT(taken.told_share, 0.9);
}

TEST(Blank, KnowsTheFrictionWithinItsError) {
  int beyond = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const ToolForce tool = tool_force(cut({.spread = 0.03, .seed = seed}), 0, 1.0);
    const std::size_t middle = tool.grid.size() / 2;
    const double truth = 0.3 + tool.grid[middle];
    const double error =
        tool.closing.spread[middle] / std::sqrt(static_cast<double>(tool.closing.cycles[middle]));
    EXPECT_NEAR(tool.closing.mean[middle], truth, 5.0 * error) << seed;
    EXPECT_NEAR(tool.opening.mean[middle], -truth, 5.0 * error) << seed;
    beyond += std::abs(tool.closing.mean[middle] - truth) > 2.0 * error ? 1 : 0;
  }
  EXPECT_LE(beyond, 2);
}

// The jackknife of a mean over cycles is its standard error: spread / sqrt(n).
TEST(Blank, IsAsWellKnownAsItsPartsSay) {
  const schema::Recording blank = cut({.spread = 0.03});
  const ToolForce whole = tool_force(blank, 0, 1.0);
  const std::size_t parts = whole.used.size();
  const std::size_t middle = whole.grid.size() / 2;
  double mean = 0.0;
  double squares = 0.0;
  for (std::size_t part = 0; part < parts; ++part) {
    const ToolForce others = tool_force(blank, 0, 1.0, CyclePart{.part = part, .parts = parts});
    EXPECT_EQ(others.used.size(), parts - 1);
    EXPECT_EQ(std::ranges::count(others.used, whole.used[part]), 0);
    const double off = others.closing.mean[middle] - whole.closing.mean[middle];
    mean += off / static_cast<double>(parts);
    squares += off * off;
  }
  EXPECT_NEAR(mean, 0.0, 1e-3);
  const double error = whole.closing.spread[middle] / std::sqrt(static_cast<double>(parts));
  const double n = static_cast<double>(parts);
  EXPECT_NEAR(std::sqrt((n - 1.0) / n * squares) / error, 1.0, 0.05);
}

TEST(Blank, NamesTheRowsThatItDoesNotCover) {
  const Prepared prepared =
      prepare(cut({.stiffness = 8.0, .reach = 0.6, .seed = 2}), {.blank = blank_of({})});
  const BlankTaken& taken = *prepared.blank;
  std::size_t named = 0;
  std::size_t beyond = 0;
  for (const RowSpan& span : taken.uncovered) {
    named += span.end - span.begin;
    for (std::size_t row = span.begin; row < span.end; ++row)
      beyond += prepared.recording.position[row] > 0.52 ? 1 : 0;
  }
  EXPECT_EQ(named, taken.rows - taken.covered);
  EXPECT_EQ(beyond, static_cast<std::size_t>(std::ranges::count_if(prepared.recording.position,
                                                                   [](double x) { return x > 0.52; })));
}

TEST(Blank, CountsAlongATurnedAxis) {
  const Tool tissue{.stiffness = 8.0, .direction = -1.0, .seed = 2};
  const Prepared prepared = prepare(cut(tissue), {.blank = blank_of({.direction = -1.0})});
  for (const std::size_t row : rows_of(prepared.recording, schema::Phase::closing)) {
    const double truth = 8.0 * std::max(0.0, -prepared.recording.position[row] - 0.2);
    EXPECT_NEAR(prepared.recording.force_measured[row], truth, 0.03);
  }
}

TEST(Blank, TellsInertiaWhereThereIsAny) {
  for (const double direction : {1.0, -1.0}) {
    const BlankInertia heavy =
        tool_force(cut({.inertia = 0.02, .direction = direction}), 0, direction).inertia;
    EXPECT_TRUE(heavy.is_determined);
    EXPECT_NEAR(*heavy.value, 0.02, 0.001);
  }
  const BlankInertia none = tool_force(cut({.inertia = 0.0}), 0, 1.0).inertia;
  EXPECT_FALSE(none.is_determined);
  EXPECT_LT(std::abs(*none.value), 0.002);

  // Then it goes off another motion, too: at half of the acceleration.
  const Tool slower{.inertia = 0.02, .stroke_s = 0.55, .seed = 3};
  const Prepared prepared = prepare(cut(slower), {.blank = blank_of({.inertia = 0.02})});
  for (const std::size_t row : rows_of(prepared.recording, schema::Phase::closing))
    EXPECT_NEAR(prepared.recording.force_measured[row], 0.0, 0.06);
}

TEST(Blank, SaysWhichRowsItDoesNotCover) {
  const Tool farther{.stiffness = 8.0, .reach = 0.7, .seed = 2};
  const schema::Recording before = cut(farther);
  const Prepared kept = prepare(before, {.blank = blank_of({})});
  EXPECT_GT(kept.blank->out_of_range.rows, 250U);
  EXPECT_GT(kept.blank->out_of_range.least, 0.47);
  EXPECT_EQ(kept.recording.rows(), before.rows());
  for (std::size_t row = 0; row < before.rows(); ++row) {
    if (before.position[row] <= 0.52) continue;
    EXPECT_EQ(kept.recording.force_measured[row], before.force_measured[row]);
  }
  EXPECT_THAT(kept.warnings, testing::Contains(HasSubstr("stay as they are")));

  BlankOptions dropping = blank_of({});
  dropping.drop = true;
  const Prepared dropped = prepare(before, {.blank = dropping});
  EXPECT_EQ(dropped.recording.rows(), kept.blank->covered);
}

TEST(Blank, CoversNoStrokeOfAnotherSpeed) {
  const Tool slow{.stroke_s = 1.5, .seed = 2};
  EXPECT_THAT([&] { (void)prepare(cut(slow), {.blank = blank_of({})}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("it covers no row")));
  BlankOptions wide = blank_of({});
  wide.speed_factor = 5.0;
  EXPECT_THAT(prepare(cut(slow), {.blank = wide}).warnings,
              testing::Contains(HasSubstr("it closes at 0.46")));
}

TEST(Blank, SaysWhereTheToolHadLessFriction) {
  const Prepared prepared = prepare(cut({.friction = 0.1, .seed = 2}), {.blank = blank_of({.spread = 0.01})});
  EXPECT_GT(prepared.blank->pulling_share, 0.2);
  EXPECT_GT(prepared.blank->negative_after, prepared.blank->negative_before);
  EXPECT_THAT(prepared.warnings, testing::Contains(HasSubstr("the tool had less friction")));
}

TEST(Blank, TakesFromTheBranchesWhatItTakesFromTheRows) {
  const Prepared prepared = prepare(cut({.stiffness = 8.0, .seed = 2}), {.blank = blank_of({})});
  const schema::Cycles fresh = find_cycles(prepared.recording, {});
  const std::size_t middle = fresh.grid.size() / 2;
  EXPECT_NEAR(prepared.recording.cycles->closing_mean[middle], fresh.closing_mean[middle], 0.01);
  EXPECT_NEAR(prepared.recording.cycles->opening_mean[middle], fresh.opening_mean[middle], 0.01);
}

TEST(Blank, IsNamedInTheHistory) {
  const BlankOptions blank = blank_of({});
  const Prepared prepared = prepare(cut({.seed = 2}), {.blank = blank});
  EXPECT_THAT(prepared.recording.header.history,
              HasSubstr("blank blank.h5 " + blank.recording.header.uuid + " sha256:00ff taken off"));
}

TEST(Blank, IsOfTheSameToolAndAnotherRecording) {
  const schema::Recording recording = cut({.seed = 2});
  const auto refused = [&](const auto& change, const char* why) {
    BlankOptions blank = blank_of({});
    change(blank.recording);
    EXPECT_THAT([&] { (void)prepare(recording, {.blank = blank}); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refused([](auto& blank) { blank.header.device_uri = "sim:other"; }, "its device is 'sim:other'");
  refused([](auto& blank) { blank.axes[0].name = "x"; }, "its first axis is 'x'");
  refused([](auto& blank) { blank.axes[0].force_unit = "N·m"; }, "its force unit is 'N·m'");
  refused([](auto& blank) { blank.axes[0].lever = 0.2; }, "its lever is '0.2'");
  refused([&](auto& blank) { blank.header.uuid = recording.header.uuid; }, "it is the recording itself");
  refused([](auto& blank) { blank.force_measured.clear(); }, "no measured force");
}

}  // namespace
}  // namespace kerf::bench

#include "replay/path.h"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion.h"
#include "replay/path_rendering.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

const drivers::DeviceInfo& scissors() {
  static const drivers::DeviceInfo info = drivers::open_device("sim:scissors")->info();
  return info;
}

Path path_of(const schema::Recording& recording, const PathOptions& options = {}) {
  return make_path(select_rows(recording, {}, "cut.h5"), scissors(), 1e-3, options);
}

std::vector<double> played(const Path& path, double from, std::size_t ticks) {
  PathPlayer player(path);
  std::vector<double> all;
  for (std::size_t tick = 0; tick < ticks; ++tick) all.push_back(player.step(1, {from}).position[0]);
  return all;
}

double largest_step(const std::vector<double>& positions) {
  double largest = 0.0;
  for (std::size_t i = 1; i < positions.size(); ++i)
    largest = std::max(largest, std::abs(positions[i] - positions[i - 1]));
  return largest;
}

TEST(PathPlayer, BeginsWhereTheDeviceIsAndMovesWithinItsSpeed) {
  const Path path = path_of(test::sine_of_scissors(), {.move_share_per_s = 0.1});
  const double speed = 0.1 * 3.14159265358979 / 3.0;  // a tenth of 60 deg a second
  const auto positions = played(path, 1.0, 12000);
  EXPECT_EQ(positions.front(), 1.0);
  EXPECT_NEAR(positions[static_cast<std::size_t>(1000.0 * 1.875 * 0.6 / speed) + 1], 0.4, 1e-9);
  EXPECT_LE(largest_step({positions.begin(), positions.begin() + 10000}), speed * 1e-3 * (1.0 + 1e-6));
}

TEST(PathPlayer, PlaysEveryRowOnItsTick) {
  const schema::Recording recording = test::sine_of_scissors();
  const auto positions = played(path_of(recording), recording.position[0], recording.rows());
  for (std::size_t row = 0; row < recording.rows(); ++row)
    EXPECT_NEAR(positions[row], recording.position[row], 1e-12) << row;
}

TEST(PathPlayer, ScalesTheVelocityWithTheSpeed) {
  const schema::Recording recording = test::sine_of_scissors();
  for (const double speed : {0.1, 0.5, 3.0, 10.0}) {
    const Path path = path_of(recording, {.speed = speed});
    PathPlayer player(path);
    double before = recording.position[0];
    for (int tick = 0; tick < static_cast<int>(2000.0 / speed) - 1; ++tick) {
      const Reference reference = player.step(1, {before});
      if (tick > 0) {
        EXPECT_NEAR(reference.velocity[0], 1e3 * (reference.position[0] - before), 0.02 * speed * speed);
      }
      before = reference.position[0];
    }
    EXPECT_NEAR(before, recording.position.back(), 1e-3);
  }
}

TEST(PathPlayer, TakesMissedTicksAsTimeThatWentBy) {
  const Path path = path_of(test::sine_of_scissors());
  PathPlayer every(path);
  PathPlayer third(path);
  (void)every.step(1, {0.9});
  (void)third.step(1, {0.9});
  for (int i = 0; i < 1500; ++i) {
    (void)every.step(1, {});
    (void)every.step(1, {});
    EXPECT_EQ(every.step(1, {}).position[0], third.step(3, {}).position[0]);
  }
}

TEST(PathPlayer, ComesBackSoftlyAtTheSeamOfALoop) {
  const schema::Recording half = test::sine_of_scissors(500);  // ends at the other end of the stroke
  const Path path = path_of(half, {.loop = true});
  const auto positions = played(path, 0.4, 20000);
  EXPECT_LE(largest_step(positions), 0.2 * 3.15e-3 / 3.0 * 1.01 + 0.4 * 0.0016);
  EXPECT_LE(largest_step(positions), 0.1 * 2.0 * 3.1416e-3);  // that of the sine itself
  EXPECT_LT(*std::min_element(positions.begin() + 15000, positions.end()), 0.21);
  EXPECT_GT(*std::max_element(positions.begin() + 15000, positions.end()), 0.39);
}

TEST(PathPlayer, WaitsThroughAGapAndMovesOn) {
  const schema::Recording recording = test::without_rows(test::sine_of_scissors(), 100, 400);
  const auto kept = played(path_of(recording), 0.4, 4000);
  EXPECT_EQ(kept[150], kept[350]);
  EXPECT_NEAR(kept[150], recording.position[99], 1e-12);
  EXPECT_LE(largest_step(kept), 0.1 * 2.0 * 3.1416e-3);
  const auto filled = played(path_of(recording, {.bridge = true}), 0.4, 1000);
  EXPECT_NEAR(filled[250],
              recording.position[99] + 151.0 / 301.0 * (recording.position[100] - recording.position[99]),
              1e-9);
}

TEST(Path, RefusesWhatTheDeviceCannotDo) {
  const auto refusal = [](const schema::Recording& recording,
                          const PathOptions& options = {}) -> std::string {
    try {
      (void)path_of(recording, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  schema::Recording recording = test::sine_of_scissors();
  recording.position[600] = 1.2;
  EXPECT_THAT(refusal(recording),
              HasSubstr("row 600 at 0.6 s: theta = 1.2 rad is out of the device's range"));
  recording.position[600] = 0.35;  // 0.1 rad in a tick
  EXPECT_THAT(refusal(recording), HasSubstr("row 600 at 0.6 s: theta would move at"));
  EXPECT_EQ(refusal(recording, {.speed = 0.1}), "");
  recording.axes[0].position_unit = "m";
  recording.axes[0].force_unit = "N·m";
  EXPECT_THAT(refusal(recording), HasSubstr("has none such"));
}

TEST(Path, RefusesAnAxisWithoutARange) {
  drivers::DeviceInfo boundless = scissors();
  boundless.axes[0].lower = boundless.axes[0].upper = 0.4;
  EXPECT_THROW(
      (void)make_path(select_rows(test::without_rows(test::sine_of_scissors(), 1, 2000), {}, "cut.h5"),
                      boundless, 1e-3, {}),
      std::invalid_argument);
}

TEST(PathCoupling, IsThatOfAHandWithinHalfOfWhatTheDeviceMayExert) {
  const auto usual = couplings({}, scissors());
  EXPECT_NEAR(usual[0].stiffness, 500.0 * 0.28 / 7.58, 1e-9);
  EXPECT_NEAR(usual[0].force_limit, 3.79, 1e-9);
  EXPECT_NEAR(usual[1].force_limit, 5.0, 1e-9);
  const auto own =
      couplings({.stiffness = {"100", "x_s=50"}, .damping = {}, .force_limit = {"theta=1"}}, scissors());
  EXPECT_NEAR(own[0].stiffness, 100.0 * 0.28 / 7.58, 1e-9);
  EXPECT_EQ(own[1].stiffness, 50.0);
  EXPECT_EQ(own[0].force_limit, 1.0);
  const CouplingOptions bad[] = {
      {.stiffness = {"stiff"}}, {.stiffness = {"y=1"}}, {.damping = {"-1"}}, {.force_limit = {"theta=8"}}};
  for (const CouplingOptions& options : bad)
    EXPECT_THROW((void)couplings(options, scissors()), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

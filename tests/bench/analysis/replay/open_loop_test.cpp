#include "replay/open_loop.h"

#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "laws/placement.h"
#include "motion.h"
#include "run/run.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

const std::atomic<bool> never{false};

NamedLaw kelvin(double parallel_n_per_rad = 8.0) {
  const std::array values{parallel_n_per_rad, 7.0, 130.0};
  return {.name = "kelvin",
          .file = {.law = models::Law::make("kelvin", values),
                   .contact = {.position = 0.5, .direction = -1.0},
                   .axis = "theta",
                   .position_unit = "rad",
                   .force_unit = "N"}};
}

/// A law in closed loop with the simulated scissors, as `kerf check --virtual --record` leaves it.
schema::Recording closed_loop(const LawFile& law, const std::string& uri, double ramp_s) {
  const test::TemporaryFolder folder;
  (void)run_on_device({.device_uri = uri,
                       .seconds = 3.0,
                       .virtual_time = true,
                       .law = law,
                       .ramp_s = ramp_s,
                       .record = folder / "loop.h5"},
                      never);
  return schema::read_recording(folder / "loop.h5");
}

OpenLoopResult through(const schema::Recording& recording, const std::vector<NamedLaw>& laws,
                       const SelectOptions& select = {}) {
  return run_open_loop(select_rows(recording, select, "loop.h5"), laws, {}, never);
}

TEST(OpenLoop, GivesAgainWhatTheLawGaveInClosedLoopToTheLastBit) {
  for (const char* uri : {"sim:scissors?noise=off&encoder=off", "sim:scissors?seed=4"}) {
    const schema::Recording recording = closed_loop(kelvin().file, uri, 0.0);
    const OpenLoopResult result = through(recording, {kelvin()});
    const AxisComparison& theta = result.laws.at(0).axes.at(0);
    ASSERT_TRUE(theta.exact);
    EXPECT_GT(theta.exact->untouched, 2900U) << uri;
    EXPECT_EQ(theta.exact->identical, theta.exact->untouched) << uri;
    EXPECT_EQ(theta.worst, 0.0);
    EXPECT_GT(theta.force_rms, 0.5);
  }
}

/// A device that has the axes of a law.
std::string device_for(const LawFile& law) {
  for (std::string uri : {"sim:scissors", "sim:pose6", "sim:premium"}) {
    try {
      (void)axes_for(law, drivers::open_device(uri)->info());
      return uri;
    } catch (const std::invalid_argument&) {
      continue;
    }
  }
  return "";
}

TEST(OpenLoop, IsExactForEveryLawOfTheExamples) {
  std::size_t exact = 0;
  for (const auto& entry : std::filesystem::directory_iterator(KERF_SOURCE_DIR "/examples")) {
    if (!entry.path().string().ends_with(".law.toml")) continue;
    const LawFile law = read_law_file(entry.path());
    const std::string uri = device_for(law);
    ASSERT_NE(uri, "") << entry.path();
    const schema::Recording recording = closed_loop(law, uri, 0.0);
    const OpenLoopResult result = through(recording, {{.name = "law", .file = law}});
    for (const AxisComparison& one : result.laws.at(0).axes) {
      if (!one.exact) continue;  // it met nothing on this axis
      EXPECT_EQ(one.exact->identical, one.exact->untouched) << entry.path();
      EXPECT_GT(one.exact->untouched, 2500U) << entry.path();
      ++exact;
    }
  }
  EXPECT_GT(exact, 20U);
}

TEST(OpenLoop, LeavesTheRampOfASoftStartOutOfWhatMustBeIdentical) {
  const schema::Recording recording = closed_loop(kelvin().file, "sim:scissors", 0.25);
  const AxisComparison theta = through(recording, {kelvin()}).laws.at(0).axes.at(0);
  EXPECT_EQ(theta.exact->untouched, 2750U);
  EXPECT_EQ(theta.exact->identical, theta.exact->untouched);
}

TEST(OpenLoop, IsNotExactFromTheMiddleOnForALawThatRemembers) {
  const schema::Recording recording = closed_loop(kelvin().file, "sim:scissors", 0.0);
  const AxisComparison theta =
      through(recording, {kelvin()}, {.from_s = 1.5, .to_s = {}, .cycles = {}}).laws.at(0).axes.at(0);
  EXPECT_LT(theta.exact->identical, theta.exact->untouched);
}

TEST(OpenLoop, SeesAMissedTickAsTheLoopSawIt) {
  // The loop steps a law over the time since the last tick: rows that it never had are no loss.
  schema::Recording recording = test::sine_of_scissors();
  models::Law law = kelvin().file.law;
  const schema::Recording gappy = test::without_rows(recording, 300, 302);
  const OpenLoopResult result = through(gappy, {kelvin()});
  models::Law::State state = law.initial_state();
  double force = 0.0;
  for (std::size_t row = 0; row < gappy.rows(); ++row) {
    const double period_s = row == 300 ? 3.0 * (1.0 / 1000.0) : 1.0 / 1000.0;
    force = law.step(state, kelvin().file.contact.motion(gappy.position[row], gappy.velocity[row]), period_s)
                .force;
    ASSERT_EQ(result.laws[0].force[row][0], force) << row;
  }
}

TEST(OpenLoop, MeasuresTheDifferenceInNewtonsAndJnds) {
  // Against a force twice as stiff in its parallel spring: the difference is 8 N/rad times the depth.
  schema::Recording recording = test::sine_of_scissors();
  const OpenLoopResult stiff = through(recording, {kelvin(16.0)});
  for (std::size_t row = 0; row < recording.rows(); ++row)
    recording.force_commanded[row] = stiff.laws[0].force[row][0];
  const OpenLoopResult both = through(recording, {kelvin(16.0), kelvin(8.0)});
  EXPECT_EQ(both.laws[0].axes[0].worst, 0.0);
  const AxisComparison& soft = both.laws[1].axes[0];
  EXPECT_FALSE(soft.measured);
  EXPECT_NEAR(soft.worst, -8.0 * 0.3, 1e-9);
  EXPECT_NEAR(soft.worst_at_s, 0.5, 1e-9);
  double squares = 0.0;
  for (const double position : recording.position) squares += std::pow(8.0 * (0.5 - position), 2);
  EXPECT_NEAR(soft.rms, std::sqrt(squares / 2001.0), 1e-9);
  EXPECT_NEAR(soft.jnd, 0.07 * soft.force_rms, 1e-12);
  EXPECT_NEAR(soft.rms_jnd, soft.rms / soft.jnd, 1e-12);
}

TEST(OpenLoop, IsComparedWithASensorWhereNothingWasCommanded) {
  const OpenLoopResult result = through(test::sine_of_scissors(), {kelvin()});
  EXPECT_TRUE(result.laws[0].axes[0].measured);
  EXPECT_FALSE(result.laws[0].axes[0].exact);
  EXPECT_EQ(result.laws[0].axes[0].force_rms, 1.0);
}

TEST(OpenLoop, GivesTheSameForcesByTheWallClock) {
  const Source source = select_rows(test::sine_of_scissors(200), {}, "cut.h5");
  const OpenLoopResult fast = run_open_loop(source, {kelvin()}, {}, never);
  const OpenLoopResult paced = run_open_loop(source, {kelvin()}, {.realtime = true}, never);
  EXPECT_EQ(fast.laws[0].force, paced.laws[0].force);
  EXPECT_TRUE(paced.punctuality);
}

TEST(OpenLoop, LeavesARecordingWithBothForces) {
  const Source source = select_rows(test::sine_of_scissors(), {}, "cut.h5");
  const OpenLoopResult result = run_open_loop(source, {kelvin()}, {}, never);
  const schema::Recording made = recording_of(source, result.laws[0]);
  EXPECT_EQ(made.force_commanded[500], result.laws[0].force[500][0]);
  ASSERT_EQ(made.channels.size(), 1U);
  EXPECT_EQ(made.channels[0].name, "theta_force_recorded");
  EXPECT_EQ(made.channels[0].values[500], 1.0);
  EXPECT_NE(made.header.uuid, source.recording.header.uuid);
}

TEST(OpenLoop, RefusesALawForWhichTheRecordingHasNoAxis) {
  NamedLaw law = kelvin();
  law.file.position_unit = "m";
  EXPECT_THROW((void)through(test::sine_of_scissors(), {law}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

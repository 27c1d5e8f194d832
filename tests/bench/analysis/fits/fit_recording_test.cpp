#include "fits/fit_recording.h"

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fits/asked_fit.h"
#include "fits/fit_files.h"
#include "recordings/whole_recording.h"

namespace kerf::bench {
namespace {

/// A Kelvin tissue (k1 300 N/m, k2 500 N/m, b 50 N·s/m) under a tool that goes 5 mm in and out at 1 Hz. Its
/// velocity is one that a driver would give: useless, so that a fit has to derive its own.
schema::Recording punch() {
  const std::array values{300.0, 500.0, 50.0};
  const models::Law law = models::Law::make("kelvin", values, {});
  models::Law::State state = law.initial_state();
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "z", .position_unit = "m", .force_unit = "N"}};
  for (std::size_t i = 0; i < 4000; ++i) {
    const double time_s = 1e-3 * static_cast<double>(i);
    const double phase = 2.0 * 3.14159265358979 * time_s;
    const models::Motion motion{.penetration = 0.0025 * (1.0 - std::cos(phase)),
                                .velocity = 0.0025 * 2.0 * 3.14159265358979 * std::sin(phase)};
    recording.time.push_back(time_s);
    recording.tick.push_back(i);
    recording.position.push_back(motion.penetration);
    recording.velocity.push_back(0.0);
    recording.force_measured.push_back(law.step(state, motion, 1e-3).force);
  }
  return recording;
}

FitRecordingOptions kelvin_only() {
  FitRecordingOptions options;
  options.models = {"kelvin"};
  options.contact = models::Contact{.position = 0.0, .direction = 1.0};
  return options;
}

double rmse(const schema::Recording& recording) {
  const RecordingFit fit = fit_recording(recording, kelvin_only());
  EXPECT_EQ(fit.laws.size(), 1U);
  return fit.laws.empty() ? 1e9 : fit.laws.front().result.rmse;
}

TEST(FitRecording, LeavesOutOneRowForAPositionThatIsNoNumberAndNotItsNeighbours) {
  schema::Recording recording = punch();
  const double whole = rmse(recording);
  recording.position[1234] = std::numeric_limits<double>::quiet_NaN();
  recording.time[2345] = std::numeric_limits<double>::quiet_NaN();
  const RecordingFit fit = fit_recording(recording, kelvin_only());
  EXPECT_EQ(fit.recordings.front().left_out, 2U);
  EXPECT_LT(rmse(recording), 2.0 * whole + 1e-3);
}

// Floor and rendering are found beside the fits, and the rows are let go of before.
TEST(FitRecording, CountsEveryPartOfEveryLawAsItIsDone) {
  FitRecordingOptions options = kelvin_only();
  options.models = {"kelvin", "scissors_analytic", "maxwell"};  // the second one is for angles
  options.fit.folds = 3;
  std::atomic<std::size_t> done{0};
  options.done = &done;
  std::vector<std::size_t> seen;
  options.fit.part_done = [&] { seen.push_back(done); };
  const RecordingFit fit = fit_recording(punch(), options);
  ASSERT_EQ(fit.laws.size(), 2U);
  // Each law by itself, its intervals and its three folds; of a law that is refused all at once.
  EXPECT_THAT(seen, testing::ElementsAre(1, 2, 3, 4, 5, 11, 12, 13, 14, 15));
  EXPECT_EQ(steps_of(options), 16U) << "and what is found of all laws together";
  EXPECT_EQ(done, 16U);
}

TEST(FitRecording, IsTheSameOnOneThreadAndOnSeveral) {
  const schema::Recording whole = punch();
  const auto fitted_on = [&whole](std::size_t threads) {
    schema::Recording recording = whole;
    FitRecordingOptions options = kelvin_only();
    options.models = {"kelvin", "exponential"};
    options.fit.threads = threads;
    const FitSource source{
        .recording = &recording, .name = "punch", .contact = *options.contact, .taken = [&recording] {
          drop_rows(recording);
        }};
    RecordingFit fit = fit_recordings(std::span(&source, 1), options);
    EXPECT_EQ(recording.rows(), 0U);
    EXPECT_EQ(fit.recordings.front().samples, 4000U);
    for (FittedLaw& law : fit.laws) law.result.seconds = 0.0;
    return fits_as_json(fit).dump();
  };
  EXPECT_TRUE(fitted_on(1) == fitted_on(3));
}

TEST(AskedFit, IsAlongTheAxisOfTheCyclesWhereNoneIsNamed) {
  schema::Recording recording = punch();
  recording.axes.insert(recording.axes.begin(), {.name = "x", .position_unit = "m", .force_unit = "N"});
  const auto beside = [](std::vector<double>& column) {
    std::vector<double> both;
    for (const double along : column) both.insert(both.end(), {0.0, along});
    column = std::move(both);
  };
  for (auto* const column : {&recording.position, &recording.velocity, &recording.force_measured})
    beside(*column);
  EXPECT_EQ(source_of({}, recording, "punch").axis, 0U);
  recording.cycles = schema::Cycles{.axis = 1};
  const FitSource source = source_of({}, recording, "punch");
  EXPECT_EQ(source.axis, 1U);
  AskedFit along_x;
  along_x.axis = "x";
  EXPECT_EQ(source_of(along_x, recording, "punch").axis, 0U);
}

}  // namespace
}  // namespace kerf::bench

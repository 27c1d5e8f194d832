#include "recordings/summary.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/data/recordings/small_recording.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::vector<std::string> warnings_of(const schema::Recording& recording) {
  return recording_summary(recording)["warnings"].get<std::vector<std::string>>();
}

TEST(RecordingSummary, GivesLengthRateAndChannels) {
  const auto summary = recording_summary(test::small_recording());
  EXPECT_EQ(summary["samples"], 11);
  EXPECT_DOUBLE_EQ(summary["duration_s"].get<double>(), 0.01);
  EXPECT_NEAR(summary["rate_hz"].get<double>(), 1000.0, 1e-6);
  EXPECT_EQ(summary["gaps"], 0);
  EXPECT_EQ(summary["channels"]["position"]["unit"], "rad");
  EXPECT_EQ(summary["channels"]["position"]["max"], 1.0);
  EXPECT_EQ(summary["channels"]["force_measured"]["min"], -10.0);
  EXPECT_TRUE(summary["warnings"].empty());
}

TEST(RecordingSummary, CountsAJumpOfTheTickAsAGap) {
  auto recording = test::small_recording();
  for (std::size_t i = 5; i < recording.rows(); ++i) recording.tick[i] += 3;
  EXPECT_EQ(recording_summary(recording)["gaps"], 1);
}

TEST(RecordingSummary, CountsALongPeriodAsAGapAndAShorterOneNot) {
  auto recording = test::small_recording();
  for (std::size_t i = 5; i < recording.rows(); ++i) recording.time[i] += 0.0014;
  EXPECT_EQ(recording_summary(recording)["gaps"], 0);
  for (std::size_t i = 5; i < recording.rows(); ++i) recording.time[i] += 0.0002;
  EXPECT_EQ(recording_summary(recording)["gaps"], 1);
}

TEST(RecordingSummary, WarnsOfTimesThatRepeatOrGoBack) {
  auto recording = test::small_recording();
  recording.time[3] = recording.time[2];
  recording.time[8] = 0.0;
  EXPECT_THAT(warnings_of(recording), Contains(HasSubstr("time repeats at 1 row")));
  EXPECT_THAT(warnings_of(recording), Contains(HasSubstr("time goes back at 1 row")));
}

TEST(RecordingSummary, WarnsOfWhatIsNotFiniteAndLeavesItOutOfTheRange) {
  auto recording = test::small_recording();
  recording.position[10] = std::numeric_limits<double>::infinity();
  recording.position[9] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(warnings_of(recording), Contains(HasSubstr("position holds 2 values that are not finite")));
  EXPECT_EQ(recording_summary(recording)["channels"]["position"]["max"], 0.8);
}

TEST(RecordingSummary, NamesEachAxisOfMany) {
  auto recording = test::small_recording();
  recording.axes.push_back({.name = "x_s", .position_unit = "m", .force_unit = "N"});
  for (auto* column : {&recording.position, &recording.velocity, &recording.force_measured}) {
    column->resize(2 * recording.rows());
  }
  const auto channels = recording_summary(recording)["channels"];
  EXPECT_EQ(channels["position.theta"]["unit"], "rad");
  EXPECT_EQ(channels["velocity.x_s"]["unit"], "m/s");
  EXPECT_EQ(channels["force_measured.x_s"]["unit"], "N");
}

TEST(RecordingSummary, HoldsForARecordingWithoutRows) {
  schema::Recording recording;
  recording.axes = {{}};
  const auto summary = recording_summary(recording);
  EXPECT_EQ(summary["samples"], 0);
  EXPECT_EQ(summary["rate_hz"], 0.0);
}

}  // namespace
}  // namespace kerf::bench

#include "views/hysteresis_loops.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segment/segment.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

constexpr double pi = 3.14159265358979;

/// Scissors that open and close once a second: the angle shrinks while they close, against 2 N, and opens
/// against 1 N.
schema::Recording cutting(double seconds, bool is_measured) {
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "x_s"}, {.name = "theta", .position_unit = "rad"}};
  for (std::size_t i = 0; i < static_cast<std::size_t>(1000.0 * seconds); ++i) {
    const double time_s = 1e-3 * static_cast<double>(i);
    const double velocity = -pi * std::sin(2.0 * pi * time_s);
    recording.time.push_back(time_s);
    recording.tick.push_back(i);
    for (const double position : {7.0, 0.5 + 0.5 * std::cos(2.0 * pi * time_s)}) {
      recording.position.push_back(position);
      recording.velocity.push_back(velocity);
    }
    const double resistance = velocity < 0.0 ? 2.0 : 1.0;
    for (const double force : {9.0, resistance}) {
      // A command opens against the closing: to greater angles.
      (is_measured ? recording.force_measured : recording.force_commanded).push_back(force);
    }
  }
  return recording;
}

struct SavedRecording {
  explicit SavedRecording(const schema::Recording& recording) { schema::write_recording(path(), recording); }
  [[nodiscard]] std::filesystem::path path() const { return folder / "r.h5"; }
  test::TemporaryFolder folder;
};

TEST(ForceLoops, AreThoseOfTheStoredCycles) {
  schema::Recording recording = cutting(5.0, true);
  recording.cycles = find_cycles(recording, {.axis = 1});
  const SavedRecording saved(recording);
  const schema::RecordingFile file(saved.path());
  const AxisCycles cycles = axis_cycles(file, 1);
  EXPECT_FALSE(cycles.segmented_here);
  EXPECT_EQ(cycles.why_none, "");
  EXPECT_EQ(cycles.cycles.size(), recording.cycles->closing.size());
  EXPECT_EQ(cycles.grid, recording.cycles->grid);
  EXPECT_EQ(cycles.closing.size(), cycles.grid.size());
  EXPECT_NEAR(cycles.closing[50], 2.0, 1e-3);
  EXPECT_NEAR(cycles.opening[50], 1.0, 1e-3);
  const auto loops = force_loops(file, 1, cycles, 2, 2);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_EQ(loops[0].cycle, 2U);
  EXPECT_EQ(loops[1].cycle, 3U);
  for (const ForceLoop& loop : loops) {
    EXPECT_EQ(loop.position.size(), loop.rows) << "of two cycles there is room for every row";
    EXPECT_GT(loop.rows, 600U);
    EXPECT_EQ(*std::max_element(loop.force.begin(), loop.force.end()), 2.0);
    EXPECT_NEAR(*std::min_element(loop.position.begin(), loop.position.end()), 0.0, 1e-9);
  }
}

TEST(ForceLoops, AreFoundWhereNobodySegmented) {
  const SavedRecording saved(cutting(5.0, true));
  const schema::RecordingFile file(saved.path());
  const AxisCycles cycles = axis_cycles(file, 1);
  EXPECT_TRUE(cycles.segmented_here);
  EXPECT_GE(cycles.cycles.size(), 4U);
  EXPECT_NEAR(cycles.closing[50], 2.0, 1e-3);
}

TEST(ForceLoops, AreAveragedOverGoodCyclesBeforeAnybodySavedThem) {
  schema::Recording recording = cutting(6.0, true);
  for (std::size_t row = 2000; row < 3000; ++row) {  // one stroke in nothing
    recording.force_measured[2 * row + 1] = 1e-3;
  }
  const SavedRecording saved(recording);
  const AxisCycles cycles = axis_cycles(schema::RecordingFile(saved.path()), 1);
  EXPECT_TRUE(cycles.segmented_here);
  EXPECT_LT(cycles.averaged, cycles.cycles.size());
  EXPECT_NEAR(cycles.closing[50], 2.0, 1e-3);
}

TEST(ForceLoops, OfACommandResist) {
  // Closing shrinks the angle, so that a command that opens resists.
  const SavedRecording saved(cutting(5.0, false));
  const schema::RecordingFile file(saved.path());
  AxisCycles cycles = axis_cycles(file, 1);
  ASSERT_EQ(cycles.why_none, "");
  EXPECT_EQ(cycles.contact.direction, -1.0);
  EXPECT_THAT(force_loops(file, 1, cycles, 1, 1).front().force, testing::Contains(2.0));
  EXPECT_NEAR(cycles.closing[50], 2.0, 1e-3);
  schema::Recording growing = cutting(5.0, false);
  for (double& position : growing.position) position = -position;
  for (double& force : growing.force_commanded) force = -force;  // which still opens
  const SavedRecording other(growing);
  const schema::RecordingFile mirrored(other.path());
  cycles = axis_cycles(mirrored, 1);
  EXPECT_EQ(cycles.contact.direction, 1.0);
  EXPECT_THAT(force_loops(mirrored, 1, cycles, 1, 1).front().force, testing::Contains(2.0));
}

TEST(ForceLoops, SayWhyThereAreNone) {
  schema::Recording still = cutting(5.0, true);
  {
    const SavedRecording saved(still);
    EXPECT_THAT(axis_cycles(schema::RecordingFile(saved.path()), 0).why_none, HasSubstr("no cycle"));
  }
  still.force_measured.clear();
  const SavedRecording saved(still);
  const schema::RecordingFile file(saved.path());
  const AxisCycles cycles = axis_cycles(file, 1);
  EXPECT_EQ(cycles.why_none, "the recording holds no force");
  EXPECT_TRUE(force_loops(file, 1, cycles, 1, 5).empty());
  EXPECT_THROW((void)axis_cycles(file, 2), std::invalid_argument);
}

TEST(ForceLoops, OfAllRowsAreThereWhereThereAreNoCycles) {
  const SavedRecording saved(cutting(5.0, true));
  const schema::RecordingFile file(saved.path());
  const ForceLoop whole = whole_loop(file, 0, axis_cycles(file, 0));
  EXPECT_GT(whole.position.size(), 100U);
  EXPECT_LE(whole.position.size(), 6000U);
  EXPECT_EQ(whole.position.size(), whole.force.size());
  schema::Recording mute = cutting(5.0, true);
  mute.force_measured.clear();
  const SavedRecording other(mute);
  const schema::RecordingFile without(other.path());
  EXPECT_TRUE(whole_loop(without, 0, axis_cycles(without, 0)).position.empty());
}

TEST(ForceLoops, PassOverPhasesThatHoldNoRows) {
  schema::Recording recording = cutting(5.0, true);
  recording.cycles = find_cycles(recording, {.axis = 1});
  const std::size_t cycles = recording.cycles->closing.size();
  recording.cycles->phases.push_back({.cycle = 77, .begin = 4000, .end = UINT64_MAX});
  recording.cycles->phases.push_back({.cycle = 78, .begin = 400, .end = 300});
  const SavedRecording saved(recording);
  EXPECT_EQ(axis_cycles(schema::RecordingFile(saved.path()), 1).cycles.size(), cycles);
}

}  // namespace
}  // namespace kerf::bench

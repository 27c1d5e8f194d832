#include "loop/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

schema::RecordingWriter writer_to(const std::filesystem::path& file) {
  return {file, schema::new_header("kerf test"), {{.name = "theta", .position_unit = "rad"}}, {}};
}

schema::Row row_of(std::uint64_t tick) {
  return {.tick = tick,
          .time_s = 1e-3 * static_cast<double>(tick),
          .position = {0.5 * static_cast<double>(tick)}};
}

TEST(Recorder, WritesEveryRowInOrder) {
  const test::TemporaryFolder folder;
  Recorder recorder(writer_to(folder / "r.h5"), {.ring_rows = 64, .lossless = true});
  for (std::uint64_t tick = 0; tick < 5000; ++tick) recorder.push(row_of(tick));
  recorder.note({.time_s = 5.0, .kind = "stop", .text = "enough"});
  recorder.close("complete");
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  ASSERT_EQ(recording.rows(), 5000U);
  for (std::uint64_t tick = 0; tick < 5000; ++tick) {
    ASSERT_EQ(recording.tick[tick], tick);
    ASSERT_EQ(recording.position[tick], 0.5 * static_cast<double>(tick));
  }
  ASSERT_EQ(recording.events.size(), 1U);
  EXPECT_EQ(recording.events[0].text, "enough");
  EXPECT_EQ(recording.header.status, "complete");
}

TEST(Recorder, LosesRowsRatherThanWaitAndTellsFromWhen) {
  const test::TemporaryFolder folder;
  Recorder recorder(writer_to(folder / "r.h5"), {.ring_rows = 8});
  for (std::uint64_t tick = 0; tick < 100'000; ++tick) recorder.push(row_of(tick));
  const std::uint64_t lost = recorder.lost();
  ASSERT_GT(lost, 0U) << "the writer looks at the ring every few milliseconds";
  recorder.close("complete");
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_EQ(recording.rows() + lost, 100'000U);
  ASSERT_EQ(recording.events.size(), 1U);
  EXPECT_EQ(recording.events[0].kind, "gap");
  EXPECT_THAT(recording.events[0].text, HasSubstr(std::to_string(lost) + " rows lost"));
  std::size_t first_gap = 0;
  while (first_gap < recording.rows() && recording.tick[first_gap] == first_gap) ++first_gap;
  EXPECT_DOUBLE_EQ(recording.events[0].time_s, 1e-3 * static_cast<double>(first_gap));
}

TEST(Recorder, LeavesThePartialFileWhenItIsNotClosed) {
  const test::TemporaryFolder folder;
  {
    Recorder recorder(writer_to(folder / "r.h5"), {.lossless = true});
    for (std::uint64_t tick = 0; tick < 100; ++tick) recorder.push(row_of(tick));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "r.h5"));
  EXPECT_TRUE(std::filesystem::exists(folder / "r.h5.partial"));
}

}  // namespace
}  // namespace kerf::bench

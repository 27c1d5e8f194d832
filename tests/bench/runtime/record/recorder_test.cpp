#include "record/recorder.h"

#include <chrono>
#include <cstdint>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/live_recording.h>

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

TEST(Recorder, LosesRowsRatherThanWaitAndTellsWhere) {
  const test::TemporaryFolder folder;
  Recorder recorder(writer_to(folder / "r.h5"), {.ring_rows = 8});
  std::uint64_t tick = 0;
  while (tick < 100'000) recorder.push(row_of(tick++));
  for (std::uint64_t before = 0; before != recorder.lost();) {  // until the writer has made room for one
    before = recorder.lost();
    recorder.push(row_of(tick++));
  }
  const std::uint64_t lost = recorder.lost();
  ASSERT_GT(lost, 0U) << "the writer looks at the ring every few milliseconds";
  recorder.close("complete");
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  EXPECT_EQ(recording.rows() + lost, tick);
  EXPECT_EQ(recording.events.back().kind, "gap");
  EXPECT_THAT(recording.events.back().text, HasSubstr(std::to_string(lost) + " rows lost"));
  std::uint64_t missing = recording.tick.front();
  for (std::size_t row = 1; row < recording.rows(); ++row) {
    const std::uint64_t jump = recording.tick[row] - recording.tick[row - 1] - 1;
    missing += jump;
    ASSERT_EQ(recording.flags[row], jump > 0 ? schema::flag_rows_lost : 0U) << "row " << row;
  }
  EXPECT_EQ(missing, lost) << "the file itself tells of every row that is not in it";
  EXPECT_EQ(recording.events.front().kind, "rows_lost");
}

TEST(Recorder, MakesAnEventOfWhatAFlagSays) {
  const test::TemporaryFolder folder;
  Recorder recorder(writer_to(folder / "r.h5"), {.lossless = true});
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    schema::Row row = row_of(tick);
    if (tick == 2500) row.flags = schema::flag_watchdog;
    recorder.push(row);
  }
  recorder.close("complete");
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  ASSERT_EQ(recording.events.size(), 1U);
  EXPECT_EQ(recording.events[0].kind, "watchdog");
  EXPECT_DOUBLE_EQ(recording.events[0].time_s, 2.5);
}

TEST(Recorder, KeepsAMarkedEventThroughACrash) {
  const test::TemporaryFolder folder;
  {
    Recorder recorder(writer_to(folder / "r.h5"), {.lossless = true});
    for (std::uint64_t tick = 0; tick < 100; ++tick) recorder.push(row_of(tick));
    recorder.mark({.time_s = 0.05, .kind = "law", .text = "kelvin"});
    recorder.note({.time_s = 0.1, .kind = "stop", .text = "known at the end alone"});
  }
  const schema::Recording recording = schema::read_recording(folder / "r.h5.partial");
  ASSERT_EQ(recording.events.size(), 1U);
  EXPECT_EQ(recording.events[0].text, "kelvin");
}

/// Rows that a file holds for whoever looks at it while it is written; none where it is being changed.
std::uint64_t rows_to_be_seen(const std::filesystem::path& file) {
  try {
    return schema::read_tail(file).rows;
  } catch (const std::exception&) {
    return 0;
  }
}

/// Whether so many rows are to be seen before the recording is closed, however long the machine takes.
bool shows(const std::filesystem::path& file, std::uint64_t rows) {
  for (int look = 0; look < 2000; ++look) {
    if (rows_to_be_seen(file) == rows) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(Recorder, ShowsTheFewRowsOfALoopThatGoesOn) {
  const test::TemporaryFolder folder;
  Recorder recorder(writer_to(folder / "r.h5"), {});
  for (std::uint64_t tick = 0; tick < 10; ++tick) recorder.push(row_of(tick));
  EXPECT_TRUE(shows(folder / "r.h5.partial", 10));
  for (std::uint64_t tick = 10; tick < 15; ++tick) recorder.push(row_of(tick));
  EXPECT_TRUE(shows(folder / "r.h5.partial", 15)) << "and again at the next flush";
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

#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/schema/recording_writer.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/recording/live_rows.h"
#include "datasets-schema/recording/same_recording.h"
#include "datasets-schema/recording/sample_recording.h"
#include "support/disks/full_disk.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Header header() { return test::sample_recording(0).header; }
std::vector<Axis> axes() { return test::sample_recording(0).axes; }

std::vector<Row> rows_of(std::size_t begin, std::size_t end) {
  std::vector<Row> rows;
  for (std::size_t i = begin; i < end; ++i) {
    const auto x = static_cast<double>(i);
    rows.push_back({.tick = i,
                    .time_s = x / 1000.0,
                    .position = {x, -x},
                    .velocity = {1.0, -1.0},
                    .force_commanded = {0.1 * x, 0.2 * x},
                    .force_measured = {0.3 * x, 0.4 * x},
                    .wake_latency_s = 1e-5F,
                    .read_time_s = 2e-5F,
                    .compute_time_s = 3e-5F,
                    .write_time_s = 4e-5F,
                    .flags = i % 2 == 0 ? 0U : static_cast<std::uint32_t>(flag_soft_start)});
  }
  return rows;
}

/// What appending those rows should give, by the bulk writer's own terms.
Recording recording_of(const std::vector<Row>& rows, const std::string& status) {
  Recording recording;
  recording.header = header();
  recording.header.status = status;
  recording.axes = axes();
  for (const auto& row : rows) {
    recording.time.push_back(row.time_s);
    recording.tick.push_back(row.tick);
    for (const std::size_t axis : {0U, 1U}) {
      recording.position.push_back(row.position[axis]);
      recording.velocity.push_back(row.velocity[axis]);
      recording.force_commanded.push_back(row.force_commanded[axis]);
      recording.force_measured.push_back(row.force_measured[axis]);
    }
    recording.wake_latency.push_back(row.wake_latency_s);
    recording.read_time.push_back(row.read_time_s);
    recording.compute_time.push_back(row.compute_time_s);
    recording.write_time.push_back(row.write_time_s);
    recording.flags.push_back(row.flags);
  }
  return recording;
}

TEST(RecordingWriter, ClosedGivesTheSameAsTheBulkWriter) {
  const test::TemporaryFolder folder;
  const auto rows = rows_of(0, 2345);
  const std::vector<Event> events{{.time_s = 0.0, .kind = "start", .text = "by hand"},
                                  {.time_s = 1.5, .kind = "fault", .text = "Kraft über 5 N"}};
  RecordingWriter writer(folder / "r.h5", header(), axes(), {.measures_force = true});
  writer.append(std::span(rows).first(1));
  writer.append(std::span(rows).subspan(1, 2000));
  writer.append_event(events[0]);
  writer.flush();
  writer.append(std::span(rows).subspan(2001));
  writer.append_event(events[1]);
  EXPECT_EQ(writer.rows(), rows.size());
  writer.close("complete");
  auto expected = recording_of(rows, "complete");
  expected.events = events;
  test::expect_same(read_recording(folder / "r.h5"), expected);
  EXPECT_THAT(validate(folder / "r.h5"), IsEmpty());
}

TEST(RecordingWriter, StandsUnderAPartialNameUntilItIsClosed) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {});
  EXPECT_EQ(writer.path(), folder / "r.h5.partial");
  EXPECT_FALSE(std::filesystem::exists(folder / "r.h5"));
  writer.append(rows_of(0, 10));
  writer.close("aborted: the cable came out");
  EXPECT_EQ(writer.path(), folder / "r.h5");
  EXPECT_FALSE(std::filesystem::exists(folder / "r.h5.partial"));
  EXPECT_EQ(read_recording(folder / "r.h5").header.status, "aborted: the cable came out");
}

TEST(RecordingWriter, KeepsFurtherChannels) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(),
                         {.channels = {{.name = "temperature", .unit = "K", .values = {}},
                                       {.name = "grip", .unit = "N", .values = {}}}});
  auto rows = rows_of(0, 1500);
  for (auto& row : rows) row.channels = {293.0 + row.time_s, -row.time_s};
  writer.append(rows);
  writer.flush();
  EXPECT_THAT(validate(folder / "r.h5.partial"), IsEmpty());
  EXPECT_EQ(read_recording(folder / "r.h5.partial").channels.size(), 2U);
  writer.close("complete");
  EXPECT_THAT(validate(folder / "r.h5"), IsEmpty());
  const Recording recording = read_recording(folder / "r.h5");
  ASSERT_EQ(recording.channels.size(), 2U);
  EXPECT_EQ(recording.channels[1].name, "grip");
  EXPECT_EQ(recording.channels[1].unit, "N");
  ASSERT_EQ(recording.channels[0].values.size(), 1500U);
  EXPECT_EQ(recording.channels[0].values[1499], 293.0 + 1.499);
  EXPECT_THROW(RecordingWriter(folder / "s.h5", header(), axes(),
                               {.channels = {{.name = "a/b", .unit = "1", .values = {}}}}),
               std::invalid_argument);
}

TEST(RecordingWriter, LeavesOutTheForceSensorThatIsNotThere) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {.measures_force = false});
  writer.append(rows_of(0, 10));
  writer.close("complete");
  EXPECT_THAT(read_recording(folder / "r.h5").force_measured, IsEmpty());
}

TEST(RecordingWriter, IsReadWhileItIsOpen) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {.measures_force = true});
  writer.append(rows_of(0, 1250));
  writer.flush();
  test::expect_same(read_recording(writer.path()), recording_of(rows_of(0, 1250), "recording"));
  EXPECT_THAT(validate(writer.path()), IsEmpty());
  writer.append(rows_of(1250, 2500));
  writer.flush();
  test::expect_same(read_recording(writer.path()), recording_of(rows_of(0, 2500), "recording"));
}

TEST(RecordingWriter, MayBeHandedToAnotherThread) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {.measures_force = true});
  std::jthread([&] { writer.append(rows_of(0, 3000)); }).join();
  writer.close("complete");
  EXPECT_EQ(read_recording(folder / "r.h5").rows(), 3000U);
}

TEST(RecordingWriter, LosesNothingThatWasFlushedWhenItsProcessIsKilled) {
  const test::TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    RecordingWriter writer(folder / "r.h5", header(), axes(), {.measures_force = true});
    writer.append(rows_of(0, 1700));
    writer.append_event({.time_s = 0.0, .kind = "start", .text = ""});
    writer.flush();
    writer.append(rows_of(1700, 5300));
    (void)std::raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  const auto found = read_recording(folder / "r.h5.partial");
  ASSERT_GE(found.rows(), 1700U);
  auto expected = recording_of(rows_of(0, found.rows()), "recording");
  expected.events = {{.time_s = 0.0, .kind = "start", .text = ""}};
  test::expect_same(found, expected);
}

TEST(RecordingWriter, LeavesAPartialFileWhenNobodyClosesIt) {
  const test::TemporaryFolder folder;
  { RecordingWriter(folder / "r.h5", header(), axes(), {}).append(rows_of(0, 10)); }
  EXPECT_EQ(read_recording(folder / "r.h5.partial").rows(), 10U);
  EXPECT_FALSE(std::filesystem::exists(folder / "r.h5"));
}

TEST(RecordingWriter, LeavesNothingWhenNothingWasAppended) {
  const test::TemporaryFolder folder;
  { const RecordingWriter writer(folder / "r.h5", header(), axes(), {}); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RecordingWriter, NeverOverwritesARecordingThatWasNotClosed) {
  const test::TemporaryFolder folder;
  { RecordingWriter(folder / "r.h5", header(), axes(), {}).append(rows_of(0, 10)); }
  EXPECT_THROW(RecordingWriter(folder / "r.h5", header(), axes(), {.replace = true}), std::invalid_argument);
  EXPECT_EQ(read_recording(folder / "r.h5.partial").rows(), 10U);
}

TEST(RecordingWriter, RefusesAnExistingTarget) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  try {
    const RecordingWriter writer(folder / "r.h5", header(), axes(), {});
    FAIL() << "was opened";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("r.h5: exists already"));
  }
}

TEST(RecordingWriter, ReplacesTheTargetOnlyWhenItIsClosed) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording(5));
  RecordingWriter writer(folder / "r.h5", header(), axes(), {.replace = true});
  writer.append(rows_of(0, 100));
  EXPECT_EQ(read_recording(folder / "r.h5").rows(), 5U);
  writer.close("complete");
  EXPECT_EQ(read_recording(folder / "r.h5").rows(), 100U);
}

TEST(RecordingWriter, CutsALongEventBetweenTwoCharacters) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {});
  writer.append_event({.time_s = 1.0, .kind = "fault", .text = "x" + std::string(254, 'y') + "é"});
  writer.close("complete");
  EXPECT_EQ(read_recording(folder / "r.h5").events.at(0).text, "x" + std::string(254, 'y'));
}

TEST(RecordingWriter, LearnsAtItsEndWhatTheDeviceCounted) {
  const test::TemporaryFolder folder;
  for (const bool has_device : {true, false}) {
    Header head = header();
    if (!has_device) {
      head.device_uri.clear();
      head.device_toml.clear();
      head.device_properties.clear();
    }
    const auto file = folder / (has_device ? "with.h5" : "without.h5");
    RecordingWriter writer(file, head, axes(), {.measures_force = true});
    writer.append(rows_of(0, 10));
    EXPECT_THROW(writer.close("complete", {{"uri", "mine"}}), std::invalid_argument);
    writer.close("complete", {{"clock_drift_ppm", 37.25}, {"scans", 10.0}});
    EXPECT_THAT(validate(file), IsEmpty());
    auto properties = head.device_properties;
    properties["clock_drift_ppm"] = 37.25;
    properties["scans"] = 10.0;
    const Recording recording = read_recording(file);
    EXPECT_EQ(recording.header.device_properties, properties);
    EXPECT_EQ(recording.header.device_uri, head.device_uri);
    EXPECT_EQ(recording.rows(), 10U);
  }
}

TEST(RecordingWriter, RefusesAStatusThatDoesNotEndARecording) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {});
  EXPECT_THROW(writer.close("recording"), std::invalid_argument);
  writer.close("complete");
}

std::error_code write_on_full_disk(const std::filesystem::path& file, rlim_t bytes) {
  const kerf::test::FullDisk disk(bytes);
  try {
    write_recording(file, test::sample_recording(2000));
    return {};
  } catch (const std::system_error& error) {
    return error.code();
  }
}

TEST(FullDisk, LeavesNothingOfARecordingWrittenAtOnce) {
  const test::TemporaryFolder folder;
  for (const rlim_t bytes : {1U, 100U, 5'000U, 50'000U, 100'000U, 200'000U}) {
    EXPECT_EQ(write_on_full_disk(folder / "r.h5", bytes).value(), EFBIG) << bytes;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << bytes;
  }
}

// The memory of a loop's process is locked, and a recording may last for days. A sanitizer counts by itself:
// there mallinfo2() sees nothing.
TEST(RecordingWriter, KeepsNothingOfTheRowsThatItWrote) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {.measures_force = true});
  const auto write = [&writer](std::size_t begin, std::size_t end) {
    for (; begin < end; begin += 1000) {
      writer.append(rows_of(begin, begin + 1000));
      writer.flush();
    }
    return mallinfo2().uordblks;
  };
  const std::size_t early = write(0, 50'000);
  const std::size_t late = write(50'000, 150'000);
  EXPECT_LE(late, early + 50'000) << "half a byte a row";
  writer.close("complete");
}

TEST(FullDisk, LeavesTheEarlierRecordingInItsPlace) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording(3));
  EXPECT_EQ(write_on_full_disk(folder / "r.h5", 50'000).value(), EFBIG);
  EXPECT_EQ(read_recording(folder / "r.h5").rows(), 3U);
}

/// Records until the disk is full; how many rows had been flushed by then.
std::uint64_t record_until_full(const std::filesystem::path& file, rlim_t bytes) {
  std::uint64_t flushed = 0;
  const kerf::test::FullDisk disk(bytes);
  try {
    RecordingWriter writer(file, header(), axes(), {.measures_force = true, .chunk_rows = 250});
    for (std::size_t begin = 0; begin < 4000; begin += 250) {
      writer.append(rows_of(begin, begin + 250));
      writer.flush();
      flushed = writer.rows();
    }
    writer.close("complete");
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), EFBIG);
  }
  return flushed;
}

TEST(FullDisk, KeepsWhatWasFlushedOfALiveRecording) {
  for (rlim_t bytes = 1'000; bytes < 500'000; bytes += 13'477) {
    const test::TemporaryFolder folder;
    const auto flushed = record_until_full(folder / "r.h5", bytes);
    if (flushed == 0) continue;
    const bool complete = std::filesystem::exists(folder / "r.h5");
    const auto found = read_recording(complete ? folder / "r.h5" : folder / "r.h5.partial");
    ASSERT_GE(found.rows(), flushed) << bytes;
    test::expect_same_samples(found, recording_of(rows_of(0, found.rows()), "recording"));
  }
}

TEST(FullDisk, IsToldOfAgainByEveryLaterCall) {
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder / "r.h5", header(), axes(), {});
  {
    const kerf::test::FullDisk disk(30'000);
    EXPECT_THROW(writer.append(rows_of(0, 5000)), std::system_error);
  }
  EXPECT_THROW(writer.append(rows_of(5000, 5001)), std::system_error);
  EXPECT_THROW(writer.flush(), std::system_error);
  EXPECT_THROW(writer.close("complete"), std::system_error);
}

TEST(RecordingWriter, ClosesThoughAReaderLocksTheFileForAMoment) {
  const test::TemporaryFolder folder;
  auto writer = test::live_writer(folder / "r.h5");
  writer.append(test::live_rows(0, 10));
  const int descriptor = ::open((folder / "r.h5.partial").c_str(), O_RDONLY);
  ASSERT_EQ(::flock(descriptor, LOCK_SH), 0);
  std::thread reader([descriptor] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ::close(descriptor);
  });
  writer.close("complete");
  reader.join();
  EXPECT_EQ(read_recording(folder / "r.h5").rows(), 10U);
}

}  // namespace
}  // namespace kerf::schema

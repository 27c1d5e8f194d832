#include <chrono>
#include <csignal>
#include <filesystem>
#include <future>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/schema/recording_writer.h>

#include "datasets-schema/recording/sample_recording.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

// Debian's own Python, as its h5py is not seen by others.
constexpr auto python = "/usr/bin/python3";
constexpr auto script = KERF_SOURCE_DIR "/tests/datasets-schema/read_with_h5py.py";

class H5py : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(python) || test::run({python, "-c", "import h5py"}).exit_status != 0) {
      GTEST_SKIP() << "python3-h5py is not installed";
    }
  }
  test::TemporaryFolder folder_;
};

void append(RecordingWriter& writer, std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t i = begin; i < end; ++i) {
    const auto x = static_cast<double>(i);
    const Row row{.tick = i, .time_s = x / 1000.0, .position = {x}};
    writer.append({&row, 1});
  }
  writer.flush();
}

TEST_F(H5py, SeesNamesShapesTypesUnitsAndScales) {
  Recording recording = test::sample_recording(5);
  recording.cycle_edits = test::sample_cycle_changes();
  write_recording(folder_ / "r.h5", recording);
  const auto outcome = test::run({python, script, "layout", (folder_ / "r.h5").string()});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
}

TEST_F(H5py, FollowsARecordingWhileItIsWritten) {
  RecordingWriter writer(folder_ / "r.h5", test::sample_recording(0).header, {Axis{}}, {});
  append(writer, 0, 300);
  auto reader = std::async(std::launch::async, [&] {
    return test::run({python, script, "follow", writer.path().string(), "900"});
  });
  // The reader ends by itself when it has seen the last row, wherever it came in.
  for (const std::uint64_t begin : {300U, 500U, 700U}) {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    append(writer, begin, begin + 200);
  }
  const auto outcome = reader.get();
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
  writer.close("complete");
}

TEST_F(H5py, ReadsARecordingWhoseWriterWasKilled) {
  const pid_t child = fork();
  if (child == 0) {
    RecordingWriter writer(folder_ / "r.h5", test::sample_recording(0).header, {Axis{}}, {});
    append(writer, 0, 300);
    std::raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  const auto outcome = test::run({python, script, "follow", (folder_ / "r.h5.partial").string(), "300"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
}

}  // namespace
}  // namespace kerf::schema

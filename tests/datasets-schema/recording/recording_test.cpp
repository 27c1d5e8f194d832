#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/recording/same_recording.h"
#include "datasets-schema/recording/sample_recording.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

TEST(Recording, ReadsBackBitForBit) {
  const test::TemporaryFolder folder;
  const auto recording = test::sample_recording();
  write_recording(folder / "r.h5", recording);
  test::expect_same(read_recording(folder / "r.h5"), recording);
}

TEST(Recording, ReadsBackBitForBitOverManyChunks) {
  const test::TemporaryFolder folder;
  const auto recording = test::sample_recording(150'000);
  write_recording(folder / "r.h5", recording);
  test::expect_same(read_recording(folder / "r.h5"), recording);
}

TEST(Recording, KeepsWhatIsSaidOfItsCycles) {
  const test::TemporaryFolder folder;
  auto recording = test::sample_recording();
  recording.cycle_flags = {
      .created = "2026-01-31T12:00:00Z",
      .software = "kerf test",
      .felt = 0.05,
      .flags = {{.cycle = 1, .fault = "put_down", .reason = "closed for 9.4 s"},
                {.cycle = 1, .fault = "accepted", .reason = "as it was asked for: 5 µN·m"}}};
  write_recording(folder / "r.h5", recording);
  const Recording read = read_recording(folder / "r.h5");
  test::expect_same(read, recording);
  ASSERT_TRUE(read.cycle_flags);
  EXPECT_EQ(read.cycle_flags->created, recording.cycle_flags->created);
  EXPECT_EQ(read.cycle_flags->software, "kerf test");
  EXPECT_EQ(read.cycle_flags->felt, 0.05);
  ASSERT_EQ(read.cycle_flags->flags.size(), 2U);
  EXPECT_EQ(read.cycle_flags->flags[1].cycle, 1U);
  EXPECT_EQ(read.cycle_flags->flags[1].fault, "accepted");
  EXPECT_EQ(read.cycle_flags->flags[1].reason, "as it was asked for: 5 µN·m");
  recording.cycle_flags->flags.clear();
  write_recording(folder / "r.h5", recording);
  EXPECT_TRUE(read_recording(folder / "r.h5").cycle_flags) << "somebody looked, and found nothing";
  recording.cycle_flags.reset();
  write_recording(folder / "r.h5", recording);
  EXPECT_FALSE(read_recording(folder / "r.h5").cycle_flags);
}

TEST(Recording, KeepsWhatAPersonChangedOfItsCycles) {
  const test::TemporaryFolder folder;
  auto recording = test::sample_recording();
  recording.cycle_edits = test::sample_cycle_changes();
  write_recording(folder / "r.h5", recording);
  EXPECT_TRUE(validate(folder / "r.h5").empty());
  const Recording read = read_recording(folder / "r.h5");
  ASSERT_EQ(read.cycle_edits.size(), 3U);
  test::expect_same(read, recording);
}

TEST(Recording, MayHaveNoRows) {
  const test::TemporaryFolder folder;
  auto recording = test::sample_recording(0);
  recording.cycles.reset();
  recording.channels.clear();
  recording.events.clear();
  write_recording(folder / "r.h5", recording);
  test::expect_same(read_recording(folder / "r.h5"), recording);
}

TEST(Recording, LeavesOutWhatDoesNotApply) {
  const test::TemporaryFolder folder;
  auto recording = test::sample_recording();
  for (auto* column :
       {&recording.wake_latency, &recording.read_time, &recording.compute_time, &recording.write_time}) {
    column->clear();
  }
  recording.force_measured.clear();
  recording.flags.clear();
  recording.channels.clear();
  recording.cycles.reset();
  recording.header.device_uri.clear();
  recording.header.device_toml.clear();
  recording.header.device_properties.clear();
  write_recording(folder / "r.h5", recording);
  test::expect_same(read_recording(folder / "r.h5"), recording);
}

TEST(Recording, ReplacesAnEarlierFileAndLeavesNothingBeside) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording(100));
  write_recording(folder / "r.h5", test::sample_recording(3));
  EXPECT_EQ(read_recording(folder / "r.h5").rows(), 3U);
  EXPECT_THAT(files_in(folder.path()), testing::ElementsAre("r.h5"));
}

TEST(Recording, RefusesAColumnOfAnotherLength) {
  const test::TemporaryFolder folder;
  auto recording = test::sample_recording();
  recording.velocity.pop_back();
  try {
    write_recording(folder / "r.h5", recording);
    FAIL() << "was written";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("/samples/velocity has 9 values, expected 10"));
  }
  EXPECT_THAT(files_in(folder.path()), IsEmpty());
}

TEST(Recording, RefusesAChannelWhoseNameIsAPath) {
  const test::TemporaryFolder folder;
  auto recording = test::sample_recording();
  recording.channels[0].name = "a/b";
  EXPECT_THROW(write_recording(folder / "r.h5", recording), std::invalid_argument);
  EXPECT_THAT(files_in(folder.path()), IsEmpty());
}

TEST(Recording, IsNotWrittenIntoAFolderThatIsNotThere) {
  const test::TemporaryFolder folder;
  try {
    write_recording(folder / "no/r.h5", test::sample_recording());
    FAIL() << "was written";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::no_such_file_or_directory);
    EXPECT_THAT(error.what(), HasSubstr("no/r.h5"));
  }
}

TEST(NewHeader, IsDatedAndUnique) {
  const auto header = new_header("kerf test");
  EXPECT_EQ(header.software, "kerf test");
  EXPECT_THAT(header.created, MatchesRegex("[0-9]+-[0-9]+-[0-9]+T[0-9]+:[0-9]+:[0-9]+Z"));
  EXPECT_NE(header.uuid, new_header("kerf test").uuid);
}

}  // namespace
}  // namespace kerf::schema

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/recording_file.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/changed_file.h"
#include "datasets-schema/recording/live_rows.h"
#include "datasets-schema/recording/read_by_column.h"

namespace kerf::schema {
namespace {

using testing::HasSubstr;
using testing::Not;

template <typename Action>
std::string line_of(const Action& action) {
  try {
    action();
    return "";
  } catch (const FormatError& error) {
    return error.what();
  }
}

/// Everything that can be asked of an open recording.
void read_piecewise(const std::filesystem::path& path) {
  const RecordingFile file(path);
  const auto rows = static_cast<std::size_t>(file.rows());
  for (const auto column : test::all_columns) {
    std::vector<double> values(rows * file.width(column));
    if (file.width(column) > 0) file.read(column, 0, rows, values);
  }
  std::vector<double> channel(rows);
  for (std::size_t i = 0; i < file.about().channels.size(); ++i) file.read_channel(i, 0, channel);
  std::vector<std::uint64_t> ticks(rows);
  file.read_ticks(0, ticks);
  std::vector<std::uint32_t> flags(rows);
  if (file.has_flags()) file.read_flags(0, flags);
}

/// The one line that a file which is no recording gives, read as a whole or piece by piece; empty if it was
/// read.
std::string refusal(const std::filesystem::path& file) {
  std::string line = line_of([&] { static_cast<void>(read_recording(file)); });
  EXPECT_EQ(line_of([&] { read_piecewise(file); }), line);
  return line;
}

std::string refusal_after(const std::function<void(hid_t)>& change) {
  return refusal(test::ChangedFile(change).path());
}

TEST(ForeignFile, TextIsNotARecording) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "notes.h5", "time,position\n0,1\n");
  EXPECT_THAT(refusal(folder / "notes.h5"), HasSubstr("notes.h5: not an HDF5 file"));
  EXPECT_THROW(static_cast<void>(validate(folder / "notes.h5")), FormatError);
}

TEST(ForeignFile, AnEmptyFileIsNotARecording) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "empty.h5", "");
  EXPECT_THAT(refusal(folder / "empty.h5"), HasSubstr("not an HDF5 file"));
}

TEST(ForeignFile, AMissingFileOrAFolderIsBadUsage) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(static_cast<void>(read_recording(folder / "none.h5")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(read_recording(folder.path())), std::invalid_argument);
  EXPECT_THROW(RecordingFile{folder / "none.h5"}, std::invalid_argument);
  EXPECT_THROW(RecordingFile{folder.path()}, std::invalid_argument);
}

TEST(ForeignFile, OfAnotherSchemaIsNamed) {
  EXPECT_THAT(refusal_after([](hid_t file) { test::set_text(file, "/", "schema", "kerf.session"); }),
              HasSubstr("/ attribute 'schema': found 'kerf.session', expected 'kerf.recording'"));
}

TEST(ForeignFile, WithoutASchemaIsNamed) {
  EXPECT_THAT(refusal_after([](hid_t file) { test::remove_attribute(file, "/", "schema"); }),
              HasSubstr("/ attribute 'schema': found nothing, expected 'kerf.recording'"));
}

TEST(ForeignFile, OfALaterVersionIsNamed) {
  EXPECT_THAT(
      refusal_after([](hid_t file) { test::set_number<std::uint32_t>(file, "/", "schema_version", 2); }),
      HasSubstr("/ attribute 'schema_version': found 2, expected 1"));
}

TEST(ForeignFile, WithAWrongTypeIsNamed) {
  EXPECT_THAT(
      refusal_after([](hid_t file) { test::replace_dataset<std::uint32_t>(file, "/samples/tick", {5}); }),
      HasSubstr("/samples/tick: found uint32, expected uint64"));
}

TEST(ForeignFile, WithoutADatasetIsNamed) {
  EXPECT_THAT(refusal_after([](hid_t file) { test::remove_link(file, "/events"); }),
              HasSubstr("/events: found nothing, expected a dataset"));
}

TEST(ForeignFile, WithRowCountsThatDifferIsNamed) {
  EXPECT_THAT(refusal_after([](hid_t file) {
                test::replace_dataset<double>(file, "/samples/velocity", {9, 2});
              }),
              HasSubstr("/samples/velocity: found 9 rows, expected 5 as in /samples/time"));
}

TEST(ForeignFile, ThatClaimsMoreRowsThanItCanHoldIsNamed) {
  constexpr hsize_t absurd = 1'000'000'000'000;
  EXPECT_THAT(refusal_after([](hid_t file) {
                for (const char* path : {"/samples/time", "/samples/position"}) {
                  h5::Extent extent = h5::describe(h5::open(file, path).id()).extent;
                  extent.front() = absurd;
                  h5::call(H5Dset_extent, h5::open(file, path).id(), extent.data());
                }
              }),
              HasSubstr("1000000000000 values in a file of"));
}

TEST(ForeignFile, WithRecordsLongerThanItCanHoldIsNamed) {
  EXPECT_THAT(refusal_after([](hid_t file) {
                test::remove_link(file, "/events");
                constexpr std::size_t absurd = 1U << 20U;
                const std::vector<h5::Field> fields{
                    {"time", "float64", 8, 0}, {"kind", "text", absurd, 8}, {"text", "text", 16, 8 + absurd}};
                static_cast<void>(h5::create_dataset(
                    file, "/events", h5::record_type(fields, 24 + absurd).id(), {.extent = {1000}}));
              }),
              HasSubstr("/events: found 1000 values in a file of"));
}

TEST(ForeignFile, IsRefusedInOneLineWhateverItsNamesAre) {
  const std::string line = refusal_after([](hid_t file) {
    test::replace_dataset<std::uint32_t>(file, "/samples/channels/a", {5});
    h5::call(H5Lmove, file, "/samples/channels/a", file, "/samples/channels/two\nlines \x1b[31m", H5P_DEFAULT,
             H5P_DEFAULT);
  });
  EXPECT_THAT(line, HasSubstr("/samples/channels/two?lines ?[31m: found uint32, expected float64"));
}

TEST(ForeignFile, IsReadDespiteWhatTheSchemaDoesNotKnow) {
  EXPECT_EQ(refusal_after([](hid_t file) {
              test::set_text(file, "/", "note", "x");
              test::remove_attribute(file, "/", "uuid");
            }),
            "");
}

TEST(DamagedFile, CutShortAnywhereIsRefusedInOneLine) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  const std::string bytes = test::read_text(folder / "r.h5");
  for (std::size_t length = 0; length < bytes.size(); length += 301) {
    test::write_text(folder / "cut.h5", bytes.substr(0, length));
    const std::string line = refusal(folder / "cut.h5");
    ASSERT_THAT(line, HasSubstr("cut.h5: ")) << length << " bytes";
    ASSERT_THAT(line, Not(HasSubstr("\n")));
  }
}

TEST(DamagedFile, CutShortWhileItWasRecordedIsReadOrRefusedInOneLine) {
  const test::TemporaryFolder folder;
  auto writer = test::live_writer(folder / "r.h5");
  writer.append(test::live_rows(0, 3000));
  writer.flush();
  const std::string bytes = test::read_text(folder / "r.h5.partial");
  for (std::size_t length = 0; length < bytes.size(); length += 1777) {
    test::write_text(folder / "cut.h5", bytes.substr(0, length));
    const std::string line = refusal(folder / "cut.h5");
    ASSERT_THAT(line, Not(HasSubstr("\n"))) << length << " bytes";
  }
}

TEST(DamagedFile, WithTextsOverwrittenIsRefusedHoweverItWasWritten) {
  const test::TemporaryFolder folder;
  write_recording(folder / "written.h5", test::sample_recording());
  auto writer = test::live_writer(folder / "recorded.h5");
  writer.append(test::live_rows(0, 3000));
  writer.close("complete");
  for (const char* name : {"written.h5", "recorded.h5"}) {
    const std::string sound = test::read_text(folder / name);
    const std::string signature("GCOL\1\0\0\0", 8);
    std::size_t heaps = 0;
    for (auto at = sound.find(signature); at != std::string::npos; at = sound.find(signature, at + 1)) {
      std::string bytes = sound;
      bytes.replace(at + 24, 8, 8, '\xff');  // the length of its first text
      test::write_text(folder / "hurt.h5", bytes);
      EXPECT_THAT(refusal(folder / "hurt.h5"), HasSubstr("its texts are overwritten")) << name;
      ++heaps;
    }
    EXPECT_GT(heaps, 0U);
  }
}

TEST(DamagedFile, CutShortIsAViolation) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  test::write_text(folder / "r.h5", test::read_text(folder / "r.h5").substr(0, 9000));
  const auto violations = validate(folder / "r.h5");
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_THAT(violations[0].found, HasSubstr("truncated file"));
}

}  // namespace
}  // namespace kerf::schema

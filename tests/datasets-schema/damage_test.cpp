#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/changed_file.h"

namespace kerf::schema {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The one line that a file which is no recording gives; empty if it was read.
std::string refusal(const std::filesystem::path& file) {
  try {
    static_cast<void>(read_recording(file));
    return "";
  } catch (const FormatError& error) {
    return error.what();
  }
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

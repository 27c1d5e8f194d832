#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/repair.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/recording/live_rows.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A recording whose writer went away without closing it.
void leave_open(const std::filesystem::path& file, std::size_t rows) {
  auto writer = test::live_writer(file);
  writer.append(test::live_rows(0, rows));
}

std::string refusal(const std::filesystem::path& name, const RepairOptions& options = {}) {
  try {
    (void)repair(name, options);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(Repair, ClosesWhatWasLeftOpen) {
  for (const auto* name : {"r.h5", "r.h5.partial"}) {
    const test::TemporaryFolder folder;
    leave_open(folder / "r.h5", 1234);
    const Repaired repaired = repair(folder / name, {});
    EXPECT_EQ(repaired.file, folder / "r.h5");
    EXPECT_EQ(repaired.rows, 1234U);
    EXPECT_DOUBLE_EQ(repaired.duration_s, 1.233);
    EXPECT_FALSE(std::filesystem::exists(folder / "r.h5.partial"));
    EXPECT_THAT(validate(folder / "r.h5"), IsEmpty());
    const Recording recording = read_recording(folder / "r.h5");
    EXPECT_THAT(recording.header.status, StartsWith("aborted: "));
    EXPECT_EQ(recording.rows(), 1234U);
    EXPECT_EQ(recording.position[2 * 1233], 1233.0);
    ASSERT_EQ(recording.events.size(), 1U);
    EXPECT_EQ(recording.events[0].kind, "repair");
  }
}

TEST(Repair, IsReadByAnyHdf5Reader) {
  const test::TemporaryFolder folder;
  leave_open(folder / "r.h5", 100);
  (void)repair(folder / "r.h5", {});
  const test::Outcome outcome =
      test::run({"/usr/bin/python3", "-c",
                 "import h5py,sys; print(len(h5py.File(sys.argv[1])['samples/time']))", folder / "r.h5"});
  EXPECT_EQ(outcome.output, "100\n") << outcome.errors;
}

TEST(Repair, LeavesARecordingAloneThatIsStillWritten) {
  const test::TemporaryFolder folder;
  auto writer = test::live_writer(folder / "r.h5");
  writer.append(test::live_rows(0, 10));
  EXPECT_THAT(refusal(folder / "r.h5"), HasSubstr("is still being recorded"));
  writer.close("complete");
  EXPECT_THAT(refusal(folder / "r.h5"), HasSubstr("there is nothing to repair"));
  EXPECT_THAT(refusal(folder / "none.h5"), HasSubstr("there is no such file"));
}

TEST(Repair, ReplacesNothingUnlessForced) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "r.h5", "precious");
  {
    RecordingWriter writer(folder / "r.h5", new_header("kerf test"), {{.name = "theta"}}, {.replace = true});
    writer.append(test::live_rows(0, 10));
  }
  EXPECT_THAT(refusal(folder / "r.h5"), HasSubstr("exists already"));
  EXPECT_EQ(test::read_text(folder / "r.h5"), "precious");
  EXPECT_TRUE(std::filesystem::exists(folder / "r.h5.partial"));
  EXPECT_EQ(repair(folder / "r.h5", {.replace = true}).rows, 10U);
}

TEST(Repair, WritesElsewhereAndKeepsThePartialFile) {
  const test::TemporaryFolder folder;
  leave_open(folder / "r.h5", 10);
  EXPECT_EQ(repair(folder / "r.h5", {.output = folder / "closed.h5"}).file, folder / "closed.h5");
  EXPECT_TRUE(std::filesystem::exists(folder / "r.h5.partial"));
  EXPECT_THAT(validate(folder / "closed.h5"), IsEmpty());
}

}  // namespace
}  // namespace kerf::schema

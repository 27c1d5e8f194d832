#include "recordings/whole_recording.h"

#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/data/recordings/small_recording.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

TEST(WholeRecording, IsReadWhereThereIsMemory) {
  const test::TemporaryFolder folder;
  const schema::Recording small = test::small_recording();
  schema::write_recording(folder / "r.h5", small);
  EXPECT_EQ(read_whole_recording(folder / "r.h5").position, small.position);
}

TEST(WholeRecording, IsRefusedBeforeItIsReadWhereThereIsNone) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "r.h5", "");
  std::filesystem::resize_file(folder / "r.h5", std::uintmax_t{1} << 42U);
  try {
    (void)read_whole_recording(folder / "r.h5");
    FAIL() << "no machine has 20 TiB";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENOMEM);
    EXPECT_THAT(error.what(), testing::HasSubstr("r.h5: needs 20480.00 GiB of memory for all rows at once"));
  }
}

TEST(FittedColumns, AreWhatAFitTakesAndNoMore) {
  const test::TemporaryFolder folder;
  schema::Recording small = test::small_recording();
  small.force_commanded.assign(11, 3.0);
  small.compute_time.assign(11, 1e-6F);
  small.flags.assign(11, 2);
  small.channels = {{.name = "b", .unit = "N", .values = std::vector<double>(11, 2.0)}};
  schema::write_recording(folder / "r.h5", small);
  const schema::Recording read = read_fitted_columns(folder / "r.h5");
  EXPECT_EQ(read.header.uuid, small.header.uuid);
  EXPECT_EQ(read.axes[0].name, "theta");
  EXPECT_EQ(read.time, small.time);
  EXPECT_EQ(read.tick, small.tick);
  EXPECT_EQ(read.position, small.position);
  EXPECT_EQ(read.velocity, small.velocity);
  EXPECT_EQ(read.force_measured, small.force_measured);
  EXPECT_TRUE(read.force_commanded.empty()) << "there is a sensor";
  EXPECT_TRUE(read.compute_time.empty());
  EXPECT_TRUE(read.flags.empty());
}

TEST(FittedColumns, HaveTheCommandedForceWhereThereIsNoSensor) {
  const test::TemporaryFolder folder;
  schema::Recording small = test::small_recording();
  small.force_commanded = std::move(small.force_measured);
  small.force_measured.clear();
  schema::write_recording(folder / "r.h5", small);
  EXPECT_EQ(read_fitted_columns(folder / "r.h5").force_commanded, small.force_commanded);
}

TEST(DroppedRows, LeaveWhatIsSaidOfThem) {
  schema::Recording small = test::small_recording();
  drop_rows(small);
  EXPECT_EQ(small.rows(), 0U);
  EXPECT_TRUE(small.position.empty());
  EXPECT_EQ(small.axes[0].name, "theta");
}

}  // namespace
}  // namespace kerf::bench

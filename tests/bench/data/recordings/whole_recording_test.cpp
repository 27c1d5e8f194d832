#include "recordings/whole_recording.h"

#include <cerrno>
#include <cstdint>
#include <system_error>

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

}  // namespace
}  // namespace kerf::bench

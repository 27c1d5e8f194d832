#include "files/disk_room.h"

#include <limits>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

constexpr std::uintmax_t more_than_there_is = std::numeric_limits<std::uintmax_t>::max();

TEST(DiskRoom, IsAskedForWhereTheFileIsToStand) {
  const test::TemporaryFolder folder;
  EXPECT_NO_THROW(require_disk(folder / "r.h5", 1, "a row"));
  for (const char* file : {"r.h5", "folder/to/be/made/r.h5"}) {
    try {
      require_disk(folder / file, more_than_there_is, "5 rows");
      FAIL() << file;
    } catch (const std::system_error& error) {
      EXPECT_EQ(error.code(), std::errc::no_space_on_device);
      EXPECT_THAT(error.what(), testing::HasSubstr((folder / file).string() + ": needs about "));
      EXPECT_THAT(error.what(), testing::HasSubstr(" GiB of the disk for 5 rows, and "));
    }
  }
}

}  // namespace
}  // namespace kerf::bench

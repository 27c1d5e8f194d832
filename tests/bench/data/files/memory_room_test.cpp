#include "files/memory_room.h"

#include <limits>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

constexpr std::uintmax_t no_limit = std::numeric_limits<std::uintmax_t>::max();

TEST(MemoryRoom, IsTheLeastOfAGroupAndThoseItBelongsTo) {
  const test::TemporaryFolder tree;
  std::filesystem::create_directories(tree / "user/lab");
  EXPECT_EQ(memory_room_of_group(tree.path(), "/user/lab"), no_limit);
  test::write_text(tree / "user/lab/memory.max", "max\n");
  test::write_text(tree / "user/lab/memory.current", "100\n");
  EXPECT_EQ(memory_room_of_group(tree.path(), "/user/lab"), no_limit);
  test::write_text(tree / "user/memory.max", "5000\n");
  test::write_text(tree / "user/memory.current", "1000\n");
  EXPECT_EQ(memory_room_of_group(tree.path(), "/user/lab"), 4000U);
  test::write_text(tree / "user/lab/memory.max", "300\n");
  EXPECT_EQ(memory_room_of_group(tree.path(), "/user/lab"), 200U);
  EXPECT_EQ(memory_room_of_group(tree.path(), "/user"), 4000U);
  EXPECT_EQ(memory_room_of_group(tree.path(), "/"), no_limit);
  test::write_text(tree / "user/lab/memory.current", "400\n");
  EXPECT_EQ(memory_room_of_group(tree.path(), "/user/lab"), 0U) << "it has more than it may";
}

TEST(MemoryRoom, IsWhatIsAskedForBeforeItIsTaken) {
  EXPECT_GT(memory_room(), 0U);
  EXPECT_LT(memory_room(), no_limit);
  EXPECT_NO_THROW(require_memory("a.txt", 1, "a row"));
  try {
    require_memory("a.txt", std::uintmax_t{1} << 60U, "5 rows");
    FAIL();
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENOMEM);
    EXPECT_THAT(error.what(),
                testing::StartsWith("a.txt: needs 1073741824.00 GiB of memory for 5 rows, and "));
  }
}

}  // namespace
}  // namespace kerf::bench

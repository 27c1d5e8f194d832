#include "inputs/copied_input.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

class CopiedInput : public testing::Test {
 protected:
  CopiedInput() {
    fs::create_directory(folder_ / "drawer");
    plan_.folder = folder_ / "drawer";
  }
  test::TemporaryFolder folder_;
  StudyPlan plan_;
};

TEST_F(CopiedInput, IsMadeOnceAndTakenWithoutTheDrawer) {
  test::write_text(folder_ / "drawer/a.txt", "1 2 3\n");
  const fs::path copy = copied_input(plan_, {.path = "a.txt"}, folder_ / "S");
  EXPECT_EQ(test::read_text(copy), "1 2 3\n");
  fs::remove_all(folder_ / "drawer");
  EXPECT_EQ(copied_input(plan_, {.path = "a.txt"}, folder_ / "S"), copy);
}

// A log of 2 GB is neither read nor copied; what is no file is the file's failure, not the study's end.
TEST_F(CopiedInput, IsNoneOfWhatIsNoFileOfADrawer) {
  test::write_text(folder_ / "drawer/log.csv", "");
  fs::resize_file(folder_ / "drawer/log.csv", std::uintmax_t{2} << 30U);
  fs::create_directory_symlink(folder_ / "drawer", folder_ / "drawer/loop");
  const auto copied = [&](const char* path) {
    return [this, path] { (void)copied_input(plan_, {.path = path}, folder_ / "S"); };
  };
  EXPECT_THAT(copied("log.csv"), ThrowsMessage<std::invalid_argument>(HasSubstr("2.1 GB")));
  EXPECT_THROW(copied("loop")(), std::invalid_argument);
  EXPECT_THROW(copied("nowhere.txt")(), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder_ / "S/inputs/log.csv"));
}

// A copy, a recording with its results of twice the text, tables and report of once.
TEST_F(CopiedInput, CountsForTheDiskUntilItIsThere) {
  test::write_text(folder_ / "drawer/a.txt", std::string(1000, '1'));
  test::write_text(folder_ / "drawer/b.gz", std::string(100, '1'));
  test::write_text(folder_ / "drawer/c.txt", std::string(9000, '1'));
  plan_.files = {{.path = "a.txt"}, {.path = "b.gz"}, {.path = "c.txt", .ignored = "a note"}};
  const fs::path study = folder_ / "S";
  EXPECT_EQ(bytes_of_run(plan_, study), 4000U + 1300U);
  (void)copied_input(plan_, plan_.files[0], study);
  fs::create_directories(study / "recordings/a");
  test::write_text(study / "recordings/a/result.json", "{}");
  EXPECT_EQ(bytes_of_run(plan_, study), 1000U + 1300U);
}

}  // namespace
}  // namespace kerf::bench

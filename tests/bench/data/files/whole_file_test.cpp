#include "files/whole_file.h"

#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

TEST(WholeFile, ReadsBackWhatItWrote) {
  const test::TemporaryFolder folder;
  const std::string content("a\0b\r\n", 5);
  write_whole_file(folder / "x", content);
  write_whole_file(folder / "x", content);
  EXPECT_EQ(read_whole_file(folder / "x"), content);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(WholeFile, NamesTheFileThatCannotBeReadOrWritten) {
  const test::TemporaryFolder folder;
  const auto message = [](const auto& action) -> std::string {
    try {
      action();
    } catch (const std::system_error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([&] { (void)read_whole_file(folder / "none"); }),
            "cannot read " + (folder / "none").string() + ": No such file or directory");
  EXPECT_EQ(message([&] { write_whole_file(folder / "no" / "x", "text"); }),
            "cannot write " + (folder / "no" / "x").string() + ": No such file or directory");
  EXPECT_EQ(message([&] { (void)read_whole_file(folder.path()); }),
            "cannot read " + folder.path().string() + ": Is a directory");
}

TEST(WholeFile, AFailedRenameLeavesNothingBehind) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "target");  // a rename onto a folder fails after the content was written
  EXPECT_THROW(write_whole_file(folder / "target", "text"), std::system_error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(WholeFile, ReplacesOnlyWhenAsked) {
  const test::TemporaryFolder folder;
  EXPECT_NO_THROW(require_output(folder / "x", false));
  write_whole_file(folder / "x", "");
  EXPECT_THROW(require_output(folder / "x", false), std::invalid_argument);
  EXPECT_NO_THROW(require_output(folder / "x", true));
}

TEST(WholeFile, KnowsBeforeTheWorkThatNothingCanBeWritten) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "file", "");
  EXPECT_NO_THROW(require_output(folder / "to" / "be" / "made", false));
  EXPECT_NO_THROW(require_output("beside_us", false));
  EXPECT_THROW(require_output(folder / "file" / "x", false), std::system_error);
  EXPECT_THROW(require_output(folder / "file" / "below" / "x", true), std::system_error);
}

}  // namespace
}  // namespace kerf::bench

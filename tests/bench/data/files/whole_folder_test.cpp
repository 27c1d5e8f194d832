#include "files/whole_folder.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using schema::Existing;
using test::read_text;
using test::write_text;

class WholeFolderTest : public testing::Test {
 protected:
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }
  test::TemporaryFolder folder_;
};

TEST_F(WholeFolderTest, AppearsOnceItIsCommitted) {
  WholeFolder fits(folder_ / "fits", Existing::keep);
  write_text(fits.path() / "f", "new");
  EXPECT_FALSE(fs::exists(folder_ / "fits"));
  fits.commit();
  EXPECT_EQ(read_text(folder_ / "fits" / "f"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(WholeFolderTest, LeavesNothingWithoutThat) {
  {
    const WholeFolder fits(folder_ / "fits", Existing::keep);
    write_text(fits.path() / "f", "new");
  }
  EXPECT_EQ(entries(), 0U);
}

TEST_F(WholeFolderTest, MayBeNamedWithASlashAndDeep) {
  WholeFolder fits(folder_ / "a/b/", Existing::keep);
  write_text(fits.path() / "f", "new");
  fits.commit();
  EXPECT_EQ(read_text(folder_ / "a/b/f"), "new");
}

TEST_F(WholeFolderTest, JoinsTheResultsOfOthers) {
  fs::create_directories(folder_ / "fits/points");
  write_text(folder_ / "fits/points/theirs", "theirs");
  WholeFolder fits(folder_ / "fits", Existing::keep);
  fs::create_directory(fits.path() / "points");
  write_text(fits.path() / "points/ours", "ours");
  EXPECT_FALSE(fs::exists(folder_ / "fits/points/ours"));
  fits.commit();
  EXPECT_EQ(read_text(folder_ / "fits/points/theirs"), "theirs");
  EXPECT_EQ(read_text(folder_ / "fits/points/ours"), "ours");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "fits"), {}), 1);
}

TEST_F(WholeFolderTest, LosesNothingOfTwoThatJoinAtOnce) {
  constexpr int rounds = 100;
  const auto join = [this](const std::string& whose) {
    for (int i = 0; i < rounds; ++i) {
      WholeFolder fits(folder_ / "fits", Existing::keep);
      write_text(fits.path() / (whose + std::to_string(i)), whose);
      fits.commit();
    }
  };
  const pid_t other = ::fork();
  if (other == 0) {
    join("theirs");
    ::_exit(0);
  }
  join("ours");
  int status = 1;
  ASSERT_EQ(::waitpid(other, &status, 0), other);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "fits"), {}), 2 * rounds);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(WholeFolderTest, ReplacesTheSameNamesIfAsked) {
  fs::create_directory(folder_ / "fits");
  for (const auto* name : {"f", "g"}) write_text(folder_ / "fits" / name, "old");
  WholeFolder fits(folder_ / "fits", Existing::replace);
  write_text(fits.path() / "f", "new");
  fits.commit();
  EXPECT_EQ(read_text(folder_ / "fits/f"), "new");
  EXPECT_EQ(read_text(folder_ / "fits/g"), "old");
}

TEST_F(WholeFolderTest, ReplacesThemAllAtOnce) {
  fs::create_directory(folder_ / "fits");
  write_text(folder_ / "fits/f", "old");
  const auto inode_of = [&] {
    struct stat status {};
    stat((folder_ / "fits").c_str(), &status);
    return status.st_ino;
  };
  const auto before = inode_of();
  WholeFolder fits(folder_ / "fits", Existing::replace);
  write_text(fits.path() / "f", "new");
  fits.commit();
  EXPECT_NE(inode_of(), before) << "the folder itself is another one: there is no moment with some of each";
}

TEST_F(WholeFolderTest, StaysTheSameFolderWhereSomebodyIsInIt) {
  fs::create_directory(folder_ / "fits");
  write_text(folder_ / "fits/f", "old");
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "fits");
  WholeFolder fits(".", Existing::replace);
  write_text(fits.path() / "f", "new");
  fits.commit();
  EXPECT_EQ(read_text("f"), "new") << "seen from within";
  fs::current_path(before);
}

TEST_F(WholeFolderTest, KeepsBothWhereSomebodyWroteTheSameMeanwhile) {
  WholeFolder fits(folder_ / "fits", Existing::keep);
  for (const auto* name : {"f", "g"}) write_text(fits.path() / name, "ours");
  fs::create_directory(folder_ / "fits");
  write_text(folder_ / "fits/f", "theirs");
  EXPECT_THROW(fits.commit(), schema::NameTaken);
  EXPECT_EQ(read_text(folder_ / "fits/f"), "theirs");
  EXPECT_FALSE(fs::exists(folder_ / "fits/g"));
  EXPECT_EQ(read_text(folder_ / "fits-2/f"), "ours");
  EXPECT_EQ(read_text(folder_ / "fits-2/g"), "ours");
}

}  // namespace
}  // namespace kerf::bench

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/schema/unfinished.h>

#include "support/program.h"

namespace kerf::schema {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// The number of a process that has ended.
std::string ended_process() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return std::to_string(child);
}

class Unfinished : public testing::Test {
 protected:
  fs::path file_of(const std::string& process) {
    const fs::path file = folder_ / ("r.h5.writing-" + process);
    test::write_text(file, "half");
    return file;
  }
  fs::path folder_of(const std::string& process) {
    const fs::path folder = folder_ / ("fits.writing-" + process);
    fs::create_directory(folder);
    test::write_text(folder / "kelvin.law.toml", "half");
    return folder;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Unfinished, OfTheDeadIsRemoved) {
  const std::string process = ended_process();
  const fs::path file = file_of(process);
  const fs::path folder = folder_of(process);
  EXPECT_THAT(remove_unfinished(folder_.path()), UnorderedElementsAre(file, folder));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(Unfinished, OfTheLivingStays) {
  const fs::path file = file_of(std::to_string(getpid()));
  EXPECT_THAT(remove_unfinished(folder_.path()), IsEmpty());
  EXPECT_TRUE(fs::exists(file));
}

TEST_F(Unfinished, StaysWhileItIsMarkedWhateverItsNumberSays) {
  const std::string process = ended_process();  // as one looks that lives in another container
  const fs::path file = file_of(process);
  const fs::path folder = folder_of(process);
  {
    const WriteMark of_file(file);
    const WriteMark of_folder(folder);
    EXPECT_THAT(remove_unfinished(folder_.path()), IsEmpty());
  }
  EXPECT_THAT(remove_unfinished(folder_.path()), UnorderedElementsAre(file, folder));
}

TEST_F(Unfinished, IsNotWhatOnlyLooksLikeIt) {
  for (const std::string name : {"r.h5.partial", "x.writing-", "x.writing-12a", "writing-1", "x.writing--1"})
    test::write_text(folder_ / name, "mine");
  EXPECT_THAT(remove_unfinished(folder_.path()), IsEmpty());
}

TEST_F(Unfinished, InNoFolderIsNothing) { EXPECT_THAT(remove_unfinished(folder_ / "none"), IsEmpty()); }

}  // namespace
}  // namespace kerf::schema

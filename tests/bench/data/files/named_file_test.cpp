#include "files/named_file.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "files/mapped_file.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(NamedFile, HoldsWhatStandsInIt) {
  const test::TemporaryFolder folder;
  const std::string content = std::string(100'000, 'x') + std::string("a\0b\r\n", 5);
  test::write_text(folder / "x", content);
  EXPECT_EQ(read_named_file(folder / "x"), content);
  EXPECT_EQ(MappedFile(folder / "x").text(), content);
  test::write_text(folder / "empty", "");
  EXPECT_EQ(read_named_file(folder / "empty"), "");
  EXPECT_EQ(MappedFile(folder / "empty").text(), "");
}

TEST(NamedFile, MayBeAPipe) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  const std::jthread writer([&] { test::write_text(folder / "pipe", "through a pipe"); });
  EXPECT_EQ(read_named_file(folder / "pipe"), "through a pipe");
}

TEST(NamedFile, IsNamedWronglyWhereItCannotBeOpened) {
  const test::TemporaryFolder folder;
  fs::create_symlink("loop", folder / "loop");
  for (const auto& open : {+[](const fs::path& file) { (void)read_named_file(file); },
                           +[](const fs::path& file) { const MappedFile mapped(file); }}) {
    EXPECT_EQ(refusal([&] { open(folder / "none"); }), (folder / "none").string() + ": no such file");
    EXPECT_THAT(refusal([&] { open(folder.path()); }), EndsWith(": a folder; expected a file"));
    EXPECT_THAT(refusal([&] { open(folder / "loop"); }), HasSubstr("loop: cannot be read: Too many levels"));
  }
  EXPECT_THAT(refusal([] { const MappedFile mapped("/dev/null"); }), HasSubstr("not a regular file"));
}

TEST(NamedFolder, IsNamedWronglyWhereThereIsNone) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "x", "");
  EXPECT_EQ(refusal([&] { require_named_folder(folder.path()); }), "accepted");
  for (const char* name : {"none", "x"})
    EXPECT_EQ(refusal([&] { require_named_folder(folder / name); }),
              (folder / name).string() + ": there is no such folder");
}

}  // namespace
}  // namespace kerf::bench

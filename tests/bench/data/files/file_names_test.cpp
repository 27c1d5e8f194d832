#include "files/file_names.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/named_file.h"
#include "support/as_nobody.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

TEST(FileNames, KeepLettersOfAnyLanguageAndLeaveNoFolder) {
  EXPECT_EQ(as_file_name("liver 2/b"), "liver_2_b");
  EXPECT_EQ(as_file_name("位移-3.5"), "位移-3.5");
  EXPECT_EQ(as_file_name(".."), "_.");
  const std::string ninety_nine(99, 'a');
  EXPECT_EQ(as_file_name(fmt::format("{}é", ninety_nine)), ninety_nine);
}

TEST(FileNames, AreToldApartByNumbers) {
  NewNames names;
  EXPECT_EQ(names.take("liver"), "liver");
  EXPECT_EQ(names.take("liver"), "liver-2");
  EXPECT_EQ(names.take("liver-2"), "liver-2-2");
  EXPECT_EQ(names.take("liver"), "liver-3");
}

TEST(FilesWithin, AreInOrderOfAllFoldersThatAreLetIn) {
  const test::TemporaryFolder folder;
  for (const char* name : {"b", "a/c", "a/d/e", "out/f"}) {
    std::filesystem::create_directories((folder / name).parent_path());
    test::write_text(folder / name, "1");
  }
  std::filesystem::create_directory_symlink(folder.path(), folder / "a/round");
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_THAT(files_within(folder.path(), [](const auto& within) { return within.filename() != "out"; }),
              testing::ElementsAre(folder / "a/c", folder / "a/d/e", folder / "a/round", folder / "b",
                                   folder / "loop"));
  EXPECT_THROW((void)files_within(folder / "none"), std::invalid_argument);
}

TEST(FilesWithin, NameAFolderThatCannotBeListedAmongThem) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "locked");
  test::write_text(folder / "a", "1");
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::none);
  {
    const test::AsNobody without_rights;
    EXPECT_THAT(files_within(folder.path()), testing::ElementsAre(folder / "a", folder / "locked"));
    EXPECT_THAT([&] { (void)read_named_file(folder / "locked"); },
                testing::ThrowsMessage<std::invalid_argument>(
                    testing::HasSubstr("locked: cannot be read: Permission denied")));
  }
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_all);
}

}  // namespace
}  // namespace kerf::bench

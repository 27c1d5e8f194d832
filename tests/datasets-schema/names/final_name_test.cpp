#include <cerrno>
#include <filesystem>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/final_name.h>

#include "names/new_name.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::write_text;

class FinalName : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(FinalName, IsTakenByWhatIsFinished) {
  write_text(folder_ / "x", "new");
  take_name(folder_ / "x", folder_ / "cut.h5", Existing::keep);
  EXPECT_EQ(read_text(folder_ / "cut.h5"), "new");
  EXPECT_FALSE(fs::exists(folder_ / "x"));
}

TEST_F(FinalName, IsTakenFromWhatIsThereIfAsked) {
  write_text(folder_ / "cut.h5", "old");
  write_text(folder_ / "x", "new");
  take_name(folder_ / "x", folder_ / "cut.h5", Existing::replace);
  EXPECT_EQ(read_text(folder_ / "cut.h5"), "new");
}

TEST_F(FinalName, KeepsBothWhereSomebodyHasIt) {
  for (const std::string name : {"cut.h5", "cut-2.h5"}) write_text(folder_ / name, name);
  write_text(folder_ / "x", "new");
  try {
    take_name(folder_ / "x", folder_ / "cut.h5", Existing::keep);
    FAIL() << "the name was taken";
  } catch (const NameTaken& taken) {
    EXPECT_EQ(taken.kept(), folder_ / "cut-3.h5");
    EXPECT_THAT(taken.what(), testing::HasSubstr((folder_ / "cut-3.h5").string()));
  }
  EXPECT_EQ(read_text(folder_ / "cut.h5"), "cut.h5");
  EXPECT_EQ(read_text(folder_ / "cut-2.h5"), "cut-2.h5");
  EXPECT_EQ(read_text(folder_ / "cut-3.h5"), "new");
}

TEST_F(FinalName, KeepsTheWholeEnding) {
  write_text(folder_ / "kelvin.law.toml", "old");
  write_text(folder_ / "x", "new");
  EXPECT_THROW(take_name(folder_ / "x", folder_ / "kelvin.law.toml", Existing::keep), NameTaken);
  EXPECT_EQ(read_text(folder_ / "kelvin-2.law.toml"), "new");
}

TEST_F(FinalName, KeepsFoldersApartToo) {
  for (const std::string name : {"fits", "x"}) {
    fs::create_directory(folder_ / name);
    write_text(folder_ / name / "f", name);
  }
  EXPECT_THROW(take_name(folder_ / "x", folder_ / "fits", Existing::keep), NameTaken);
  EXPECT_EQ(read_text(folder_ / "fits" / "f"), "fits");
  EXPECT_EQ(read_text(folder_ / "fits-2" / "f"), "x");
}

/// Each way to a new name by itself, as a file system that knows no other would have it.
using Way = int (*)(const fs::path&, const fs::path&);
class WayToANewName : public FinalName, public testing::WithParamInterface<Way> {};

TEST_P(WayToANewName, GivesIt) {
  write_text(folder_ / "x", "new");
  EXPECT_EQ(GetParam()(folder_ / "x", folder_ / "cut.h5"), 0);
  EXPECT_EQ(read_text(folder_ / "cut.h5"), "new");
  EXPECT_FALSE(fs::exists(folder_ / "x"));
}

TEST_P(WayToANewName, TakesItFromNobody) {
  write_text(folder_ / "cut.h5", "old");
  write_text(folder_ / "x", "new");
  EXPECT_EQ(GetParam()(folder_ / "x", folder_ / "cut.h5"), EEXIST);
  EXPECT_EQ(read_text(folder_ / "cut.h5"), "old");
  EXPECT_EQ(read_text(folder_ / "x"), "new");
}

TEST_P(WayToANewName, GivesItToAFolderOrSaysThatItCannot) {
  fs::create_directory(folder_ / "x");
  write_text(folder_ / "x" / "f", "new");
  const int failure = GetParam()(folder_ / "x", folder_ / "fits");
  if (failure == 0) {
    EXPECT_EQ(read_text(folder_ / "fits" / "f"), "new");
  } else {
    EXPECT_TRUE(is_unknown(failure));
    EXPECT_EQ(read_text(folder_ / "x" / "f"), "new");
  }
}

INSTANTIATE_TEST_SUITE_P(By, WayToANewName,
                         testing::Values(rename_exclusively, link_exclusively, replace_placeholder),
                         [](const auto& tested) {
                           return std::string(tested.param == Way{rename_exclusively} ? "Rename"
                                              : tested.param == Way{link_exclusively} ? "Link"
                                                                                      : "Placeholder");
                         });

}  // namespace
}  // namespace kerf::schema

#include "drawer/look.h"

#include <filesystem>
#include <map>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/as_nobody.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* some_numbers = "0 1 2\n1 2 3\n2 3 4\n3 4 5\n";

class Drawer : public testing::Test {
 protected:
  std::map<std::string, DrawerFile> look(const std::string& map = "") {
    std::map<std::string, DrawerFile> found;
    std::vector<OfferedMap> maps;
    if (!map.empty()) maps.push_back({.name = map, .import = {.map = map, .options = {}}});
    for (DrawerFile& file : look_into(folder_.path(), maps)) found.emplace(file.path, file);
    return found;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Drawer, OfRubbishSaysOfEachFileWhyItTakesNoPart) {
  test::write_text(folder_ / "good.txt", some_numbers);
  test::write_text(folder_ / "empty.txt", "");
  test::write_text(folder_ / "picture.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 17));
  test::write_text(folder_ / "notes.md", "# What was cut\n\nA liver.\n");
  test::write_text(folder_ / "damaged.h5", "no HDF5");
  fs::create_directory_symlink(folder_.path(), folder_ / "loop");
  fs::create_symlink("nowhere", folder_ / "dangling.txt");
  fs::create_directory(folder_ / "again");
  test::write_text(folder_ / "again/good.txt", some_numbers);
  test::write_text(folder_ / "log.txt", "");
  fs::resize_file(folder_ / "log.txt", std::uintmax_t{2} << 30U);
  schema::write_recording(folder_ / "liver.h5", test::punch());
  fs::create_symlink("good.txt", folder_ / "a_link.txt");
  test::write_text(folder_ / ".hidden.txt", "0 1 2\n1 2 3\n2 3 4\n");
  test::write_text(folder_ / "two\nlines.txt", "0 1 2\n1 2 3\n2 3 5\n");
  const auto found = look();
  EXPECT_EQ(found.at("a_link.txt").ignored, "a link to the content of again/good.txt");
  EXPECT_EQ(found.at(".hidden.txt").ignored, "a hidden file");
  EXPECT_THAT(found.at("two\nlines.txt").ignored, HasSubstr("several lines"));
  EXPECT_EQ(found.at("good.txt").ignored, "has the content of again/good.txt");
  EXPECT_EQ(found.at("again/good.txt").ignored, "");
  EXPECT_EQ(found.at("liver.h5").ignored, "");
  EXPECT_THAT(found.at("empty.txt").ignored, HasSubstr("empty"));
  EXPECT_THAT(found.at("picture.png").ignored, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(found.at("notes.md").ignored, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(found.at("damaged.h5").ignored, testing::Not(testing::IsEmpty()));
  EXPECT_THAT(found.at("loop").ignored, HasSubstr("link to a folder"));
  EXPECT_THAT(found.at("dangling.txt").ignored, HasSubstr("link to none"));
  EXPECT_THAT(found.at("log.txt").ignored, HasSubstr("2.1 GB"));
  EXPECT_EQ(found.size(), 13U);
}

TEST_F(Drawer, TellsOfAFolderWithinThatCannotBeRead) {
  test::write_text(folder_ / "good.txt", some_numbers);
  fs::create_directory(folder_ / "locked");
  test::write_text(folder_ / "locked/more.txt", some_numbers);
  fs::permissions(folder_.path(), fs::perms(0755));
  fs::permissions(folder_ / "locked", fs::perms::none);
  {
    const test::AsNobody without_rights;
    const auto found = look();
    EXPECT_EQ(found.at("good.txt").ignored, "");
    EXPECT_EQ(found.at("locked").ignored, "cannot be read: Permission denied");
    EXPECT_EQ(found.size(), 2U);
  }
  fs::permissions(folder_ / "locked", fs::perms::owner_all);
}

TEST_F(Drawer, LeavesOutWhatDoesNotFitTheMap) {
  test::write_text(folder_ / "three.txt", some_numbers);
  test::write_text(folder_ / "two.txt", "0 1\n1 2\n2 3\n");
  const auto found = look("time=1[s],position=2[mm],force=3[N]");
  EXPECT_EQ(found.at("three.txt").ignored, "");
  EXPECT_THAT(found.at("two.txt").ignored, HasSubstr("3"));
}

TEST_F(Drawer, OfSeveralLayoutsHasForEachFileTheFirstMapThatItFits) {
  test::write_text(folder_ / "new.csv", "t,x,f\n0,1,2\n1,2,3\n2,3,4\n");
  test::write_text(folder_ / "old.csv", "F;way;clock\n0;1;2\n1;2;3\n2;3;5\n");
  const std::string new_rig = "time=t[s],position=x[mm],force=f[N]";
  const std::string old_rig = "time=clock[s],position=way[mm],force=F[N]";
  std::map<std::string, DrawerFile> found;
  for (DrawerFile& file :
       look_into(folder_.path(), {{.name = "new", .import = {.map = new_rig, .options = {}}},
                                  {.name = "old", .import = {.map = old_rig, .options = {}}}}))
    found.emplace(file.path, file);
  EXPECT_EQ(found.at("new.csv").map, "");
  EXPECT_EQ(found.at("old.csv").map, "old");
  EXPECT_EQ(found.at("old.csv").ignored, "");
}

TEST_F(Drawer, SuggestsTheMapThatHeadingsWithUnitsGive) {
  test::write_text(folder_ / "a.csv", "Time [ms],Position [mm],Force [N]\n0,1,2\n1,2,3\n2,3,4\n");
  test::write_text(folder_ / "b.csv", "Time [ms],Position,Force [N]\n0,1,2\n1,2,3\n2,3,5\n");
  const auto found = look();
  EXPECT_EQ(found.at("a.csv").map, "time=1[ms],position=2[mm],force=3[N]");
  EXPECT_EQ(found.at("b.csv").map, "");
}

// A suggestion only: whether they are is for a person to say.
TEST_F(Drawer, SuggestsFilesOfOneRecordingByTheirNames) {
  fs::create_directory(folder_ / "a");
  const std::string motion = "t [s],x [mm]\n0,1\n1,2\n2,4\n";
  const std::string force = "t [s],wire [mm],F [N]\n0,1,5\n1,2,6\n2,4,7\n";
  test::write_text(folder_ / "a/liver_slow_s1_position.csv", motion);
  test::write_text(folder_ / "a/liver_slow_s1_force.csv", force);
  test::write_text(folder_ / "a/liver_slow_s2_position.csv", motion + "3,5\n");
  test::write_text(folder_ / "liver_slow_s2_force.csv", force + "3,5,6\n");  // of another folder
  const auto found = look("time=1[s],position=2[mm],force=3[N]");
  const DrawerFile& one = found.at("a/liver_slow_s1_position.csv");
  EXPECT_EQ(one.ignored, "");
  EXPECT_EQ(one.join_suggested, "a/liver_slow_s1_force.csv");
  EXPECT_EQ(one.join, "");
  EXPECT_EQ(one.map, "time=1[s],position=2[mm]");
  EXPECT_EQ(one.join_map, "time=1[s],position=2[mm],force=3[N]");
  EXPECT_EQ(one.join_on, "position");
  EXPECT_EQ(one.tissue, "a liver");
  EXPECT_EQ(one.specimen, "s1");
  EXPECT_THAT(found.at("a/liver_slow_s1_force.csv").ignored, HasSubstr("liver_slow_s1_position.csv"));
  EXPECT_EQ(found.at("a/liver_slow_s2_position.csv").join_suggested, "");
  EXPECT_EQ(found.at("liver_slow_s2_force.csv").ignored, "");
}

TEST_F(Drawer, ThatIsNotThereIsRefused) {
  EXPECT_THROW((void)look_into(folder_ / "nowhere", {}), std::invalid_argument);
  EXPECT_THROW((void)look_into(folder_.path(), {{.name = "time", .import = {.map = "time", .options = {}}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

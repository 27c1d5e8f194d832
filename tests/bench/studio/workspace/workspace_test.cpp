#include "workspace/workspace.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

#include "http/routes.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

void put(const fs::path& file, const std::string& text = "x") {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

void write_recording_of_one_row(const fs::path& file) {
  fs::create_directories(file.parent_path());
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {schema::Axis{}};
  recording.time = {0.0};
  recording.tick = {0};
  recording.position = {0.0};
  recording.velocity = {0.0};
  schema::write_recording(file, recording);
}

class WorkspaceOfALab : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const WorkspaceEntry& it : workspace_.scan())
      all.push_back(fmt::format("{} {}", name_of(it.kind), it.name));
    return all;
  }

  test::TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
};

TEST_F(WorkspaceOfALab, KnowsFilesByTheirNamesAndWhatIsInThem) {
  write_recording_of_one_row(folder_.path() / "b" / "cut.h5");
  put(folder_.path() / "a.law.toml");
  put(folder_.path() / "cut.fit" / "fit.json");
  put(folder_.path() / "cut.h5.partial");
  put(folder_.path() / "drawer" / "study.toml");
  put(folder_.path() / "drawer" / "a.study.toml");
  put(folder_.path() / "notes.txt");
  put(folder_.path() / "not hdf5.h5");
  EXPECT_THAT(names(), ElementsAre("law a.law.toml", "recording b/cut.h5", "fit cut.fit/fit.json",
                                   "recording cut.h5.partial", "study drawer/study.toml"));
}

TEST_F(WorkspaceOfALab, ListsManyFilesBeforeItHasLookedIntoThem) {
  constexpr int many = 40;
  write_recording_of_one_row(folder_.path() / "a.h5");
  const fs::path no_hdf5 = folder_.path() / "no hdf5 0.h5";
  for (int i = 0; i < many; ++i) put(folder_.path() / fmt::format("no hdf5 {}.h5", i));
  const std::vector<WorkspaceEntry> first = workspace_.scan();
  EXPECT_EQ(first.size(), many + 1U);
  EXPECT_TRUE(std::ranges::none_of(first, [](const WorkspaceEntry& it) { return it.is_looked_into; }));
  // What is asked for is looked into at once.
  EXPECT_EQ(workspace_.find(workspace_.id_of(folder_.path() / "a.h5"), FileKind::recording).seconds, 0.0);
  EXPECT_THROW((void)workspace_.find(workspace_.id_of(no_hdf5), FileKind::recording), RequestError);
  std::vector<WorkspaceEntry> all;
  do {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    all = workspace_.scan();
  } while (std::ranges::any_of(all, [](const WorkspaceEntry& it) { return !it.is_looked_into; }));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all.front().name, "a.h5");
}

TEST_F(WorkspaceOfALab, LeavesOutWhatIsHiddenUnfinishedDeepOrLeadsOutside) {
  const test::TemporaryFolder outside;
  put(outside.path() / "secret.law.toml");
  put(folder_.path() / ".hidden.law.toml");
  put(folder_.path() / ".git" / "x.law.toml");
  put(folder_.path() / "cut.fit.writing-77" / "x.law.toml");
  put(folder_.path() / "1/2/3/4/deep.law.toml");
  put(folder_.path() / "1/2/3/4/5/deeper.law.toml");
  fs::create_symlink(outside.path() / "secret.law.toml", folder_.path() / "link.law.toml");
  fs::create_directory_symlink(outside.path(), folder_.path() / "link");
  EXPECT_THAT(names(), ElementsAre("law 1/2/3/4/deep.law.toml"));
}

TEST_F(WorkspaceOfALab, FindsByIdAloneAndOnlyTheKindAskedFor) {
  put(folder_.path() / "a.law.toml");
  const std::string id = workspace_.id_of(folder_.path() / "a.law.toml");
  EXPECT_EQ(id.size(), 16U);
  EXPECT_EQ(workspace_.find(id, FileKind::law).name, "a.law.toml");
  EXPECT_THROW((void)workspace_.find(id, FileKind::recording), RequestError);
  for (const char* other : {"a.law.toml", "../a.law.toml", "", "/etc/passwd", "0000000000000000"})
    EXPECT_THROW((void)workspace_.find(other, FileKind::law), RequestError) << other;
}

TEST_F(WorkspaceOfALab, FindsWhatHasComeAndNotWhatHasGone) {
  EXPECT_THAT(names(), ElementsAre());
  const fs::path file = folder_.path() / "a.law.toml";
  put(file);
  const std::string id = workspace_.id_of(file);
  EXPECT_EQ(workspace_.find(id, FileKind::law).path.filename(), "a.law.toml");
  fs::remove(file);
  EXPECT_THROW((void)workspace_.find(id, FileKind::law), RequestError);
  // In place of the file a link that leads outside.
  fs::create_symlink("/etc/passwd", file);
  EXPECT_THROW((void)workspace_.find(id, FileKind::law), RequestError);
}

TEST_F(WorkspaceOfALab, NamesNewFilesWithinItselfAlone) {
  EXPECT_EQ(workspace_.new_file("cut-2_a.b", ".h5"), workspace_.folder() / "cut-2_a.b.h5");
  for (const char* name :
       {"", ".", "..", "../x", "a/b", "/x", "-x", ".x", "a b", "a\nb", "ü", "a%2fb", "~", "a\\b"})
    EXPECT_THROW((void)workspace_.new_file(name, ".h5"), RequestError) << name;
  EXPECT_THROW((void)workspace_.new_file(std::string(81, 'a'), ".h5"), RequestError);
  EXPECT_THROW((void)workspace_.new_file(std::string("a\0b", 3), ".h5"), RequestError);
}

TEST_F(WorkspaceOfALab, ReplacesNothingUnasked) {
  put(folder_.path() / "a.law.toml");
  EXPECT_THROW((void)workspace_.new_file("a", ".law.toml"), RequestError);
  EXPECT_EQ(workspace_.new_file("a", ".law.toml", true).filename(), "a.law.toml");
  fs::create_symlink("/nowhere", folder_.path() / "b.law.toml");
  EXPECT_THROW((void)workspace_.new_file("b", ".law.toml"), RequestError);
}

TEST(Workspace, IsAFolderThatIsThere) {
  EXPECT_THROW(Workspace("/no/such/folder"), std::invalid_argument);
  EXPECT_THROW(Workspace("/etc/passwd"), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

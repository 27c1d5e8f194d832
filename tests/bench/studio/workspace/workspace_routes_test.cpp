#include "workspace/workspace_routes.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/unfinished.h>

#include "bench/studio/server/asker.h"
#include "laws/law_file.h"
#include "support/program.h"
#include "support/recordings.h"
#include "workspace/workspace.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class WorkspaceRoutes : public testing::Test {
 protected:
  WorkspaceRoutes() { add_workspace_routes(routes_, workspace_, "sim:scissors"); }

  json folder(const std::string& unless = "") {
    return json::parse(asker_.get("/api/workspace", {{"unless", unless}}).body);
  }
  /// The state after a change, of which the folder's asker is told.
  std::string other_than(const std::string& before, const char* what) {
    const json now = folder(before);
    EXPECT_FALSE(now.contains("unchanged")) << what;
    return now.value("state", before);
  }

  test::TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  Routes routes_;
  test::Asker asker_{routes_};
};

TEST_F(WorkspaceRoutes, TellNothingAnewUntilSomethingHasChanged) {
  std::string state = folder().at("state");
  EXPECT_EQ(folder(state), json({{"unchanged", true}}));
  schema::write_recording(folder_ / "cut.h5", test::punch({.seconds = 0.5}));
  state = other_than(state, "a recording has come");
  schema::write_recording(folder_ / "cut.h5", test::punch({.seconds = 0.6}));
  state = other_than(state, "it is another");
  std::ofstream(folder_ / "a.law.toml") << "nothing";
  state = other_than(state, "a law has come");
  fs::rename(folder_ / "a.law.toml", folder_ / "b.law.toml");
  state = other_than(state, "it has another name");
  fs::remove(folder_ / "b.law.toml");
  state = other_than(state, "it is gone");
  EXPECT_EQ(folder(state), json({{"unchanged", true}}));
}

TEST_F(WorkspaceRoutes, TellWhetherSomebodyStillWritesWhatIsNotClosed) {
  schema::write_recording(folder_ / "cut.h5.partial", test::punch({.seconds = 0.5}));
  json left = folder();
  ASSERT_EQ(left.at("recordings").size(), 1U);
  EXPECT_EQ(left["recordings"][0].at("partial"), true);
  EXPECT_FALSE(left["recordings"][0].contains("written")) << "nobody does: it ended without being closed";
  const std::string before = left.at("state");
  {
    const schema::WriteMark mark(folder_ / "cut.h5.partial");
    const json now = folder(before);
    ASSERT_TRUE(now.contains("recordings")) << "that somebody does is a change";
    EXPECT_EQ(now["recordings"][0].at("written"), true);
  }
  EXPECT_FALSE(folder()["recordings"][0].contains("written"));
}

TEST_F(WorkspaceRoutes, ListEveryFileByWhatItIs) {
  schema::write_recording(folder_ / "cut.h5", test::punch({.seconds = 0.5}));
  std::ofstream(folder_ / "a.law.toml") << "nothing";
  std::ofstream(folder_ / "fit.json") << "{}";
  const json all = folder();
  ASSERT_EQ(all.at("recordings").size(), 1U);
  const json& cut = all["recordings"][0];
  EXPECT_EQ(cut.at("name"), "cut.h5");
  EXPECT_EQ(cut.at("id"), workspace_.id_of(folder_ / "cut.h5"));
  EXPECT_EQ(cut.at("bytes"), fs::file_size(folder_ / "cut.h5"));
  EXPECT_EQ(cut.at("partial"), false);
  EXPECT_NEAR(cut.at("seconds").get<double>(), 0.5, 0.01);
  ASSERT_EQ(all.at("laws").size(), 1U);
  EXPECT_NE(all["laws"][0].at("error"), "");
  ASSERT_EQ(all.at("files").size(), 1U);
  EXPECT_EQ(all["files"][0].at("kind"), "fit");
  EXPECT_EQ(all.at("sessions").size(), 0U);
  EXPECT_EQ(all.at("unlooked"), 0);
}

TEST_F(WorkspaceRoutes, TellOfWhichRecordingsResultsAre) {
  const schema::Recording cut = test::punch({.seconds = 0.5});
  schema::write_recording(folder_ / "cut.h5", cut);
  fs::create_directory(folder_ / "elsewhere");
  std::ofstream(folder_ / "elsewhere" / "fit.json") << json({{"recording", cut.header.uuid}, {"fits", {}}});
  std::ofstream(folder_ / "study.toml") << "nothing";
  const json all = folder();
  EXPECT_EQ(all.at("recordings")[0].at("uuid"), cut.header.uuid);
  ASSERT_EQ(all.at("files").size(), 2U);
  EXPECT_EQ(all["files"][0].at("of"), json::array({cut.header.uuid}));
  EXPECT_FALSE(all["files"][1].contains("of"));
}

TEST_F(WorkspaceRoutes, ListARecordingThatIsDamagedAsThat) {
  schema::write_recording(folder_ / "cut.h5", test::punch({.seconds = 0.5}));
  EXPECT_FALSE(folder().at("recordings")[0].contains("damaged"));
  fs::resize_file(folder_ / "cut.h5", fs::file_size(folder_ / "cut.h5") / 2);
  const json cut = folder().at("recordings").at(0);
  EXPECT_EQ(cut.at("damaged"), true);
  EXPECT_FALSE(cut.contains("seconds"));
}

TEST_F(WorkspaceRoutes, TellALawAsItIsNow) {
  const fs::path file = folder_ / "a.law.toml";
  const auto axis_of_law = [&] { return folder().at("laws")[0].at("axis").get<std::string>(); };
  LawFile law{
      .law = models::Law::make("kelvin", std::vector{4.0, 3.0, 0.9}), .contact = {}, .axis = "x", .fit = {}};
  write_law_file(file, law);
  EXPECT_EQ(axis_of_law(), "x");
  EXPECT_EQ(axis_of_law(), "x") << "and is not read again";
  const auto before = fs::last_write_time(file);
  law.axis = "y";
  write_law_file(file, law);  // of as many bytes
  fs::last_write_time(file, before + std::chrono::seconds(1));
  EXPECT_EQ(axis_of_law(), "y");
}

TEST_F(WorkspaceRoutes, ListFilesWhoseNamesAreNoText) {
  schema::write_recording(folder_ / "c\xFF.h5", test::punch({.seconds = 0.5}));
  schema::write_recording(folder_ / "cut.h5", test::punch({.seconds = 0.5}));
  const json all = folder();
  ASSERT_EQ(all.at("recordings").size(), 2U);
  EXPECT_EQ(all["recordings"][1].at("name"), "c\uFFFD.h5");
  EXPECT_EQ(all["recordings"][1].at("id"), workspace_.id_of(folder_ / "c\xFF.h5"));
}

}  // namespace
}  // namespace kerf::bench

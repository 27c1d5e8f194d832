#include "studies/study_routes.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <sstream>
#include <thread>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "drawer/look.h"
#include "run/run_study.h"
#include "studies/study_view.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

std::string punch_text(double stiffness, unsigned seed, double limit_n) {
  const schema::Recording recording = test::punch(
      {.parallel_stiffness = stiffness, .seconds = 4.0, .noise_n = 0.02, .limit_n = limit_n, .seed = seed});
  std::ostringstream text;
  text << "Time [s]\tPosition [mm]\tForce [N]\n";
  for (std::size_t i = 0; i < recording.rows(); i += 4)
    text << fmt::format("{:.3f}\t{:.5f}\t{:.2f}\n", recording.time[i], 1e3 * recording.position[i],
                        recording.force_measured[i]);
  return text.str();
}

/// A lab with a drawer of two recordings, one of a sensor that is clipped in every cycle, a blank that cannot
/// be used and a note; made and run once, and copied for each test.
class StudiedLab {
 public:
  StudiedLab() {
    fs::create_directories(folder_ / "drawer");
    fs::create_directories(folder_ / "day/S");
    test::write_text(folder_ / "drawer/liver_s1_slow.txt", punch_text(210.0, 1, 99.0));
    test::write_text(folder_ / "drawer/liver_s2_slow.txt", punch_text(230.0, 2, 1.5));
    test::write_text(folder_ / "drawer/blank_slow.txt", punch_text(0.0, 3, 99.0));
    test::write_text(folder_ / "drawer/notes.md", "# What was cut\n");
    StudyPlan plan{.folder = "../../drawer",
                   .map = "time=1[s],position=2[mm],force=3[N]",
                   .laws = {"kelvin"},
                   .closing = "",
                   .compare = {"peak"},
                   .licence = "",
                   .people = {},
                   .files = look_into(folder_ / "drawer", {})};
    test::write_text(folder_ / "day/S/study.toml", study_text(plan));
    test::write_text(folder_ / "drawer/blank_slow.txt", "gone\n");
    (void)run_study(folder_ / "day/S/study.toml", {}, std::atomic<bool>{false});
  }
  [[nodiscard]] const fs::path& path() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
};

class StudyRoutes : public testing::Test {
 protected:
  StudyRoutes() {
    static const StudiedLab lab;
    fs::copy(lab.path(), folder_.path(), fs::copy_options::recursive);
    add_study_routes(routes_, workspace_);
  }

  HttpResponse get(const std::string& path, std::map<std::string, std::string> query = {}) {
    const auto asker = std::make_shared<int>();
    const HttpRequest request{
        .number = ++number_, .method = "GET", .path = path, .query = std::move(query), .asker = asker};
    auto response = routes_.respond(request, false);
    for (; !response; response = routes_.respond(request, false)) std::this_thread::yield();
    return *response;
  }
  json list() { return json::parse(get("/api/studies").body); }
  json view() { return json::parse(get("/api/study", {{"id", id()}}).body); }
  std::string id() { return workspace_.id_of(study() / "study.toml"); }
  [[nodiscard]] fs::path study() const { return folder_ / "day/S"; }
  [[nodiscard]] json written() const { return json::parse(test::read_text(study() / "study.json")); }
  /// Another content, later than the run.
  static void change(const fs::path& file, const std::string& more) {
    test::write_text(file, test::read_text(file) + more);
    fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::seconds(60));
  }

  test::TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  Routes routes_;
  std::uint64_t number_ = 0;
};

TEST_F(StudyRoutes, ListAStudyWithItsStateItsFilesAndItsFactors) {
  const json studies = list();
  ASSERT_EQ(studies.size(), 1U);
  const json& one = studies[0];
  EXPECT_EQ(one["name"], "day/S");
  EXPECT_EQ(one["error"], "");
  EXPECT_EQ(one["state"], "run");
  EXPECT_TRUE(one["changes"].empty());
  EXPECT_EQ(one["run_at"].get<std::string>().size(), 20U);
  EXPECT_EQ(one["recordings"], 3);
  EXPECT_EQ(one["blanks"], 1);
  EXPECT_EQ(one["files"], 4);
  EXPECT_EQ(one["failed"], 1);
  EXPECT_EQ(one["doubted"], 1) << "none of its cycles is good";
  EXPECT_EQ(one["tissues"], json({"liver"}));
  EXPECT_EQ(one["speeds"], json({"slow"}));
  EXPECT_EQ(one["specimens"], json({"s1", "s2"}));
}

TEST_F(StudyRoutes, CountWhatFailedAmongTheFailedAlone) {
  json results = written();
  results["recordings"][1]["doubts"] = json({"its travel is 1000 times that of the others: mm taken for m"});
  results["recordings"][0]["doubts"] = results["recordings"][1]["doubts"];
  test::write_text(study() / "study.json", results.dump());
  EXPECT_EQ(list()[0]["doubted"], 2);
  EXPECT_EQ(list()[0]["failed"], 1);
}

TEST_F(StudyRoutes, KnowNothingOfWhatWasNotRun) {
  for (const char* name : {"study.json", "report.html", "ro-crate-metadata.json", "tables", "recordings"})
    fs::remove_all(study() / name);
  const json one = list()[0];
  EXPECT_EQ(one["state"], "not run");
  EXPECT_TRUE(one["failed"].is_null());
  EXPECT_TRUE(one["doubted"].is_null());
  EXPECT_EQ(one["recordings"], 3);
  const json all = view();
  EXPECT_EQ(all["report"], false);
  EXPECT_TRUE(all["tables"].empty());
  EXPECT_TRUE(all["conclusions"].empty());
  ASSERT_EQ(all["drawer"].size(), 3U);
  EXPECT_EQ(all["drawer"][1]["name"], "liver_s1_slow");
  EXPECT_EQ(all["drawer"][1]["specimen"], "s1");
  for (const char* unknown : {"counts", "cycles", "flagged", "law", "id"})
    EXPECT_TRUE(all["drawer"][1][unknown].is_null()) << unknown;
  EXPECT_EQ(all["ignored"][0]["file"], "notes.md");
}

TEST_F(StudyRoutes, SayWhatHasChangedSinceTheRun) {
  change(folder_ / "drawer/liver_s1_slow.txt", "");
  EXPECT_EQ(list()[0]["state"], "run") << "the same content at a later time is the same file";
  change(folder_ / "drawer/liver_s1_slow.txt", "4.000\t0.00000\t0.00\n");
  EXPECT_EQ(list()[0]["state"], "changed");
  EXPECT_EQ(list()[0]["changes"], json({"liver_s1_slow.txt is another file than was run"}));
  change(study() / "study.toml", "# a word\n");
  EXPECT_EQ(list()[0]["changes"][0], "study.toml was edited since the run");
  fs::remove(study() / "ro-crate-metadata.json");
  EXPECT_THAT(list()[0]["changes"][0].get<std::string>(), HasSubstr("did not end"));
}

TEST_F(StudyRoutes, TakeAStudyThatWasHandedOnWithoutItsDrawerForUnchanged) {
  fs::remove_all(folder_ / "drawer");
  EXPECT_EQ(list()[0]["state"], "run");
}

TEST_F(StudyRoutes, NeverLookAtADrawerOutsideOfTheFolder) {
  change(folder_ / "drawer/liver_s1_slow.txt", "4.000\t0.00000\t0.00\n");
  fs::rename(folder_ / "drawer", folder_ / "elsewhere");
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "drawer");
  EXPECT_EQ(list()[0]["state"], "run") << "a link leads there";
  fs::remove(folder_ / "drawer");
  fs::rename(folder_ / "elsewhere", folder_ / "drawer");
  EXPECT_EQ(list()[0]["state"], "changed");
  Workspace day(folder_ / "day");
  const auto found = day.scan();
  const auto study = std::ranges::find(found, FileKind::study, &WorkspaceEntry::kind);
  ASSERT_NE(study, found.end());
  EXPECT_EQ(study_entry(day, *study)["state"], "run") << "of this folder it lies outside";
}

TEST_F(StudyRoutes, ShowWhatTheStudyFound) {
  const json all = view();
  const json results = written();
  for (const char* name : {"conclusions", "ignored", "comparisons", "law"})
    EXPECT_EQ(all[name], results[name]) << name;
  EXPECT_EQ(all["laws"], json({"kelvin"}));
  EXPECT_EQ(all["report"], true);
  EXPECT_EQ(all["tables"][0], "comparisons.csv");
  ASSERT_EQ(all["drawer"].size(), 3U);
  const json& failed = all["drawer"][0];
  EXPECT_EQ(failed["name"], "blank_slow");
  EXPECT_THAT(failed["failure"].get<std::string>(), HasSubstr("no longer the file"));
  EXPECT_TRUE(failed["id"].is_null());
  EXPECT_TRUE(failed["flagged"].is_null());
  const json& clipped = all["drawer"][2];
  EXPECT_EQ(clipped["id"], workspace_.id_of(study() / "recordings/liver_s2_slow/recording.h5"));
  EXPECT_EQ(clipped["flagged"].size(),
            clipped["cycles"].get<std::size_t>() - clipped["good_cycles"].get<std::size_t>());
  ASSERT_FALSE(clipped["flagged"].empty());
  EXPECT_THAT(clipped["flagged"][0]["reason"].get<std::string>(), HasSubstr("the sensor is clipped"));
}

TEST_F(StudyRoutes, LeaveOutTheParametersOfLawsThatDoNotServeMost) {
  json results = written();
  results["law"] = "exponential";
  test::write_text(study() / "study.json", results.dump());
  std::vector<std::string> names;
  const json groups = view()["groups"];
  for (const json& quantity : groups[0]["quantities"]) names.push_back(quantity["name"]);
  EXPECT_THAT(names, ElementsAre("peak", "work"));
}

TEST_F(StudyRoutes, DrawARecordingAsItsReportDoes) {
  const HttpResponse response = get("/api/study/drawn", {{"id", id()}, {"name", "liver_s2_slow"}});
  ASSERT_EQ(response.status, 200) << response.body;
  const json figure = json::parse(response.body);
  EXPECT_EQ(figure["x_label"], "penetration [mm]");
  std::vector<std::string> labels;
  for (const json& curve : figure["curves"]) labels.push_back(curve["label"]);
  EXPECT_THAT(labels, testing::Contains("flagged"));
  for (const char* name : {"", "blank_slow", "nobody", "../S/recordings/liver_s2_slow"})
    EXPECT_NE(get("/api/study/drawn", {{"id", id()}, {"name", name}}).status, 200) << name;
}

TEST_F(StudyRoutes, GiveTheReportAsADocumentAndTheTablesThatThereAre) {
  const HttpResponse report = get("/api/study/report", {{"id", id()}});
  EXPECT_EQ(report.status, 200);
  EXPECT_EQ(report.type, "text/html; charset=utf-8");
  EXPECT_TRUE(report.is_document);
  EXPECT_EQ(report.body, test::read_text(study() / "report.html"));
  const HttpResponse table = get("/api/study/table", {{"id", id()}, {"name", "groups.csv"}});
  EXPECT_EQ(table.type, "text/csv; charset=utf-8");
  EXPECT_EQ(table.body, test::read_text(study() / "tables/groups.csv"));
  test::write_text(folder_ / "secret.csv", "a\n");
  fs::create_symlink(folder_ / "secret.csv", study() / "tables/link.csv");
  for (const char* name : {"link.csv", "../study.toml", "../../../secret.csv", "/etc/passwd", "none.csv"})
    EXPECT_EQ(get("/api/study/table", {{"id", id()}, {"name", name}}).status, 404) << name;
  fs::remove(study() / "report.html");
  fs::create_symlink(folder_ / "secret.csv", study() / "report.html");
  EXPECT_EQ(get("/api/study/report", {{"id", id()}}).status, 404);
}

TEST_F(StudyRoutes, SayWhyAStudyCannotBeRead) {
  test::write_text(study() / "study.json", "{\"recordings\": [");
  EXPECT_THAT(list()[0]["error"].get<std::string>(), HasSubstr("study.json"));
  EXPECT_EQ(get("/api/study", {{"id", id()}}).status, 400);
  test::write_text(study() / "study.json", "{\"recordings\": []}");
  EXPECT_EQ(get("/api/study", {{"id", id()}}).status, 400);
  test::write_text(study() / "study.toml", "version = 7\n");
  EXPECT_THAT(list()[0]["error"].get<std::string>(), HasSubstr("expected version = 1"));
  EXPECT_EQ(get("/api/study", {{"id", id()}}).status, 400);
  EXPECT_EQ(get("/api/study", {{"id", "0"}}).status, 404);
}

}  // namespace
}  // namespace kerf::bench

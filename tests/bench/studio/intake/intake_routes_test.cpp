#include "intake/intake_routes.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "bench/studio/jobs/finished_jobs.h"
#include "bench/studio/server/asker.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr auto map = "time=1[s],position=2[mm],force=3[N]";

/// A press of a hundred rows and one that is none.
std::string press() {
  std::string text = "t [s],x [mm],F [N]\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{:.3f},{:.3f},{:.3f}\n", 0.01 * i, 0.1 * i, 0.05 * i);
  return text + "the end\n";
}

class IntakeRoutes : public testing::Test {
 protected:
  IntakeRoutes() { add_intake_routes(routes_, workspace_, jobs_, KERF_PROGRAM); }

  /// Hands over a file in two pieces. Its id.
  std::string handed_over(const std::string& name, const std::string& content) {
    const json begun = json::parse(
        ask_.post("/api/import/begin", {{"name", name}, {"bytes", content.size()}, {"modified", 1}}).body);
    const std::string id = begun.at("upload");
    const std::size_t half = content.size() / 2;
    for (const auto& [at, piece] :
         {std::pair{std::size_t{0}, content.substr(0, half)}, {half, content.substr(half)}}) {
      const auto answer =
          ask_.post_bytes("/api/import/piece", {{"upload", id}, {"at", std::to_string(at)}}, piece);
      EXPECT_EQ(answer.status, 200) << answer.body;
    }
    return id;
  }
  json preview(const std::string& id, const std::string& by, const json& options = json::object()) {
    const auto answer = ask_.post("/api/import/preview", {{"upload", id}, {"map", by}, {"options", options}});
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body);
  }
  /// As a page orders it; of files that say nothing else by one map.
  auto start(json files) {
    for (json& file : files) {
      if (!file.contains("map")) file["map"] = map;
    }
    return ask_.post("/api/import/start", {{"files", files}});
  }
  json job(const json& files) {
    const auto answer = start(files);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return test::ended_job(jobs_, json::parse(answer.body)["job"]);
  }
  json result(const std::string& id) {
    return json::parse(ask_.get("/api/import/result", {{"upload", id}}).body);
  }

  TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  Jobs jobs_;
  Routes routes_;
  test::Asker ask_{routes_};
};

TEST_F(IntakeRoutes, MakeTheRecordingThatKerfImportMakes) {
  const std::string id = handed_over("9.txt", press());
  const json ended = job({{{"upload", id}, {"name", "nine"}}});
  ASSERT_EQ(ended["state"], "done") << ended["error"];
  EXPECT_EQ(ended["file"], workspace_.id_of(folder_ / "nine.h5"));
  test::write_text(folder_ / "9.txt", press());
  const auto run = test::run_kerf({"import", (folder_ / "9.txt").string(), "--map", map, "-o",
                                   (folder_ / "by_verb.h5").string(), "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const schema::Recording here = schema::read_recording(folder_ / "nine.h5");
  const schema::Recording there = schema::read_recording(folder_ / "by_verb.h5");
  EXPECT_EQ(here.time, there.time);
  EXPECT_EQ(here.position, there.position);
  EXPECT_EQ(here.velocity, there.velocity);
  EXPECT_EQ(here.force_measured, there.force_measured);
  EXPECT_EQ(here.header.source, there.header.source) << "it names the file as it was dropped";
  const json said = result(id);
  EXPECT_EQ(said["state"], "done");
  EXPECT_EQ(said["name"], "nine.h5");
  EXPECT_EQ(said["about"]["warnings"], json::parse(run.output)["warnings"]);
  EXPECT_EQ(said["about"]["bad_line_numbers"], json({102}));
}

TEST_F(IntakeRoutes, ShowWhatWouldComeOfAFileBeforeItIsImported) {
  const std::string id = handed_over("9.txt", press());
  const json unmapped = preview(id, "");
  EXPECT_EQ(unmapped["suggested"]["map"], map);
  EXPECT_EQ(unmapped["columns"][1]["unit"], "mm");
  EXPECT_TRUE(unmapped["mapped"].empty());
  const json mapped = preview(id, map);
  EXPECT_EQ(mapped["rows"], 100);
  EXPECT_EQ(mapped["mapped"][2]["si"], "N");
  EXPECT_EQ(mapped["irregular"][0]["number"], 102);
  EXPECT_EQ(mapped["irregular"][0]["kind"], "no_data");
  const json wrong = preview(id, "time=1[s],position=2[mm],force=3[kg]");
  EXPECT_THAT(wrong["problem"].get<std::string>(), HasSubstr("is not a unit of force"));
  EXPECT_TRUE(
      preview(id, "position=2[mm],force=3[N]", {{"rate", 100}})["problem"].get<std::string>().empty());
  const auto refused = ask_.post("/api/import/preview", {{"upload", id}, {"map", "nonsense"}});
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("has no '='"));
}

TEST_F(IntakeRoutes, SayInOneLineWhatNobodyCanRead) {
  const std::string id = handed_over("photo.png", "\x89PNG\r\n\x1a\n and so on");
  const auto refused = ask_.post("/api/import/preview", {{"upload", id}, {"map", ""}});
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(json::parse(refused.body)["error"], "photo.png: a picture, not a file of numbers");
  const json ended = job({{{"upload", id}, {"name", "photo"}}});
  EXPECT_EQ(ended["state"], "failed");
  EXPECT_EQ(ended["error"], "photo.png: a picture, not a file of numbers");
  EXPECT_EQ(result(id)["state"], "failed");
  EXPECT_FALSE(fs::exists(folder_ / "photo.h5"));
}

TEST_F(IntakeRoutes, ReadEachFileByItsOwnMapping) {
  const std::string one = handed_over("one.txt", press());
  const std::string other = handed_over("other.txt", press());
  const json ended =
      job({{{"upload", one}, {"name", "one"}},
           {{"upload", other}, {"name", "other"}, {"map", "time=1[ms],position=3[mm],force=2[N]"}}});
  ASSERT_EQ(ended["state"], "done") << ended["error"];
  const schema::Recording as_said = schema::read_recording(folder_ / "one.h5");
  const schema::Recording swapped = schema::read_recording(folder_ / "other.h5");
  EXPECT_NEAR(swapped.time.back(), 1e-3 * as_said.time.back(), 1e-9);
  EXPECT_NEAR(swapped.force_measured[50], 1e3 * as_said.position[50], 1e-9);
}

TEST_F(IntakeRoutes, GoOnWithTheOtherFilesWhereOneCannotBeRead) {
  const std::string bad = handed_over("bad.txt", "no numbers at all\n");
  const std::string good = handed_over("good.txt", press());
  const json ended = job({{{"upload", bad}, {"name", "bad"}}, {{"upload", good}, {"name", "good"}}});
  EXPECT_EQ(ended["state"], "done");
  EXPECT_EQ(ended["file"], workspace_.id_of(folder_ / "good.h5"));
  EXPECT_THAT(result(bad)["error"].get<std::string>(), HasSubstr("bad.txt: no line of numbers"));
  EXPECT_EQ(result(good)["state"], "done");
}

TEST_F(IntakeRoutes, TakeNoNameThatIsTakenNorOneTwice) {
  const std::string id = handed_over("9.txt", press());
  test::write_text(folder_ / "cut.h5", "somebody's");
  const auto asked = [&](const json& files) { return start(files); };
  const auto taken = asked({{{"upload", id}, {"name", "cut"}}});
  EXPECT_EQ(taken.status, 409);
  EXPECT_THAT(taken.body, HasSubstr("cut.h5 is there already"));
  EXPECT_EQ(test::read_text(folder_ / "cut.h5"), "somebody's");
  const std::string other = handed_over("8.txt", press());
  EXPECT_EQ(asked({{{"upload", id}, {"name", "one"}}, {{"upload", other}, {"name", "one"}}}).status, 409);
  EXPECT_EQ(asked({{{"upload", id}, {"name", "../one"}}}).status, 400);
  EXPECT_EQ(asked(json::array()).status, 400);
}

TEST_F(IntakeRoutes, ImportNothingOfAFileThatHasNotComeWhole) {
  const json begun = json::parse(ask_.post("/api/import/begin", {{"name", "9.txt"}, {"bytes", 100}}).body);
  const std::string id = begun["upload"];
  (void)ask_.post_bytes("/api/import/piece", {{"upload", id}, {"at", "0"}}, "1,2,3\n");
  const auto refused = start({{{"upload", id}, {"name", "nine"}}});
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.body, HasSubstr("6 of 100 bytes have come"));
  const json overview = json::parse(ask_.get("/api/import").body);
  EXPECT_EQ(overview["uploads"][0]["have"], 6) << "a page that is loaded anew knows of it";
  EXPECT_EQ(overview["uploads"][0]["name"], "9.txt");
  (void)ask_.post("/api/import/forget", {{"upload", id}});
  EXPECT_TRUE(json::parse(ask_.get("/api/import").body)["uploads"].empty());
}

TEST_F(IntakeRoutes, KeepAMappingAsTheFileThatKerfImportTakes) {
  const json options{{"rate", 100.0},
                     {"resample", 50.0},
                     {"sheet", "Run \"1\""},
                     {"origin", {0.5, 0.0, 0.1}},
                     {"strict", true}};
  const auto saved =
      ask_.post("/api/import/mapping", {{"name", "press"}, {"map", map}, {"options", options}});
  ASSERT_EQ(saved.status, 200) << saved.body;
  const json id = json::parse(saved.body)["id"];
  const json read = json::parse(ask_.get("/api/import/mapping", {{"id", id}}).body);
  EXPECT_EQ(read["map"], map);
  EXPECT_EQ(read["options"], options);
  EXPECT_EQ(json::parse(ask_.get("/api/import").body)["mappings"][0]["name"], "press.import.toml");
  EXPECT_EQ(ask_.post("/api/import/mapping", {{"name", "press"}, {"map", map}}).status, 409);
  EXPECT_EQ(ask_.post("/api/import/mapping", {{"name", "press"}, {"map", map}, {"replace", true}}).status,
            200);
  test::write_text(folder_ / "9.txt", press());
  const auto run =
      test::run_kerf({"import", (folder_ / "9.txt").string(), "--map",
                      (folder_ / "press.import.toml").string(), "-o", (folder_ / "r.h5").string()});
  EXPECT_EQ(run.exit_status, 0) << run.errors;
  EXPECT_EQ(ask_.post("/api/import/mapping", {{"name", "bad"}, {"map", "nonsense"}}).status, 400);
}

TEST_F(IntakeRoutes, EndAnImportThatIsStopped) {
  json files = json::array();
  for (int i = 0; i < 100; ++i) {
    const std::string name = fmt::format("{}.txt", i);
    files.push_back({{"upload", handed_over(name, press())}, {"name", fmt::format("r{}", i)}});
  }
  const auto answer = start(files);
  const std::size_t number = json::parse(answer.body)["job"];
  jobs_.stop(number);
  const json ended = test::ended_job(jobs_, number);
  EXPECT_NE(ended["state"], "failed") << ended["error"];
  EXPECT_FALSE(fs::exists(folder_ / "r99.h5"));
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    EXPECT_TRUE(entry.path().extension() == ".h5" || entry.path().filename() == ".kerf-intake" ||
                entry.path().string().find(".writing-") != std::string::npos)
        << entry.path();
}

}  // namespace
}  // namespace kerf::bench

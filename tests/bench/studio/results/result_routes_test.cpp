#include "results/result_routes.h"

#include <algorithm>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/studio/jobs/finished_jobs.h"
#include "jobs/job_routes.h"
#include "laws/law_file.h"
#include "support/program.h"
#include "support/recordings.h"
#include "workspace/workspace_routes.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using test::TemporaryFolder;
using testing::HasSubstr;

/// A workspace with a recording, a law and a result, and who answers for it.
class ResultRoutes : public testing::Test {
 protected:
  ResultRoutes() {
    schema::write_recording(folder_ / "punch.h5", test::punch({.seconds = 1.0}));
    write_law_file(folder_ / "tissue.law.toml",
                   {.law = models::Law::make("kelvin", std::vector{300.0, 500.0, 50.0}), .axis = "z"});
    std::filesystem::create_directory(folder_ / "old.fit");
    test::write_text(folder_ / "old.fit/fit.json", R"({"jnd": 0.1})");
    add_result_routes(routes_, workspace_, jobs_);
    add_job_routes(routes_, jobs_);
    add_workspace_routes(routes_, workspace_, "sim:scissors");
  }

  HttpResponse answer(HttpRequest request) {
    const auto asker = std::make_shared<int>();
    request.number = ++number_;
    request.asker = asker;
    while (true) {
      if (auto response = routes_.respond(request, false)) return *response;
      std::this_thread::yield();
    }
  }
  HttpResponse get(const std::string& path, const std::map<std::string, std::string>& query = {}) {
    return answer({.method = "GET", .path = path, .query = query});
  }
  HttpResponse post(const std::string& path, const json& body) {
    return answer({.method = "POST",
                   .path = path,
                   .headers = {{"content-type", "application/json"}},
                   .body = body.dump()});
  }
  std::string id(const std::string& name) { return workspace_.id_of(folder_ / name); }

  TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  Jobs jobs_;
  Routes routes_;
  std::uint64_t number_ = 0;
};

TEST_F(ResultRoutes, TakeAnOrderAndShowItsResult) {
  const HttpResponse taken =
      post("/api/fit", {{"recording", id("punch.h5")}, {"axis", "z"}, {"models", {"kelvin"}}, {"folds", 2}});
  ASSERT_EQ(taken.status, 200) << taken.body;
  const json job = test::ended_job(jobs_, json::parse(taken.body)["job"]);
  ASSERT_EQ(job["state"], "done") << job["error"];
  EXPECT_EQ(json::parse(get("/api/jobs").body)[0], job);
  const HttpResponse result = get("/api/result", {{"id", job["file"]}});
  ASSERT_EQ(result.status, 200) << result.body;
  EXPECT_EQ(result.body, test::read_text(folder_ / "punch.fit/fit.json"));
  EXPECT_THAT(result.type, HasSubstr("application/json"));
}

TEST_F(ResultRoutes, DrawWhatEarlierVersionsWrote) {
  const std::filesystem::path stored = std::filesystem::path(KERF_SOURCE_DIR) / "tests/bench/analysis";
  for (const auto& [from, to] : {std::pair{"chart/older_chart.json", "old.chart/chart.json"},
                                 {"stability/older_wall.json", "wall.stability/stability.json"},
                                 {"stability/older_law.json", "law.stability/stability.json"}}) {
    std::filesystem::create_directory((folder_ / to).parent_path());
    std::filesystem::copy_file(stored / from, folder_ / to);
    json result = json::parse(get("/api/result", {{"id", id(to)}}).body);
    EXPECT_GE(result["figure"]["curves"].size(), 1U) << to;
    EXPECT_EQ(result["figure"]["x_range"].size(), 2U) << to;
    result.erase("figure");
    EXPECT_EQ(result, json::parse(test::read_text(folder_ / to)));
  }
  std::filesystem::create_directory(folder_ / "broken.chart");
  for (const auto* text : {"{", R"({"points": []})"}) {
    test::write_text(folder_ / "broken.chart/chart.json", text);
    const HttpResponse response = get("/api/result", {{"id", id("broken.chart/chart.json")}});
    EXPECT_EQ(response.status, 400);
    EXPECT_THAT(response.body, HasSubstr("broken.chart/chart.json is not what kerf writes"));
  }
}

TEST_F(ResultRoutes, ShowADeviceAsItStands) {
  std::filesystem::create_directory(folder_ / "axis");
  test::write_text(folder_ / "axis/identify.json", R"({"device": "falcon:0", "axes": [], "charts": []})");
  const HttpResponse device = get("/api/result", {{"id", id("axis/identify.json")}});
  ASSERT_EQ(device.status, 200) << device.body;
  EXPECT_EQ(json::parse(device.body), json::parse(test::read_text(folder_ / "axis/identify.json")));
}

TEST_F(ResultRoutes, ShowALawAndWhatItLeavesOfARecording) {
  const HttpResponse law = get("/api/law", {{"id", id("tissue.law.toml")}});
  ASSERT_EQ(law.status, 200) << law.body;
  EXPECT_EQ(json::parse(law.body)["name"], "tissue.law.toml");
  EXPECT_EQ(json::parse(law.body)["parameters"].size(), 3U);
  const HttpResponse residuals =
      get("/api/residuals",
          {{"id", id("punch.h5")}, {"axis", "z"}, {"law", id("tissue.law.toml")}, {"columns", "50"}});
  ASSERT_EQ(residuals.status, 200) << residuals.body;
  EXPECT_EQ(json::parse(residuals.body)["time_s"].size(), 50U);
  EXPECT_NEAR(json::parse(residuals.body)["rmse"], 0.005, 0.001) << "the noise of the sensor";
  const json fitted = json::parse(get("/api/laws/fitted").body);
  EXPECT_GE(fitted.size(), 10U);
  EXPECT_EQ(std::ranges::count_if(fitted, [](const json& one) { return one.at("usual").get<bool>(); }), 5);
}

TEST_F(ResultRoutes, TakeEveryOptionOfAFit) {
  const json asked{{"recording", id("punch.h5")},
                   {"axis", "z"},
                   {"models", {"piecewise"}},
                   {"rows", "all"},
                   {"cycles", "all"},
                   {"contact", 0.0},
                   {"direction", "increasing"},
                   {"rate", 500},
                   {"noise", 0.01},
                   {"segments", "2"},
                   {"folds", 0},
                   {"test_share", 0.25},
                   {"loss", "huber"},
                   {"loss_scale", 0.02},
                   {"confidence", 0.9},
                   {"weber", 0.1},
                   {"threshold", 0.04},
                   {"points_per_segment", 5}};
  const HttpResponse taken = post("/api/fit", asked);
  ASSERT_EQ(taken.status, 200) << taken.body;
  const json job = test::ended_job(jobs_, json::parse(taken.body)["job"]);
  ASSERT_EQ(job["state"], "done") << job["error"];
  const json fit = json::parse(get("/api/result", {{"id", job["file"]}}).body);
  const json& settings = fit["settings"];
  EXPECT_EQ(settings["rows"], "all");
  EXPECT_EQ(settings["loop_rate_hz"], 500.0);
  EXPECT_EQ(settings["folds"], 0);
  EXPECT_EQ(settings["test_share"], 0.25);
  EXPECT_EQ(settings["loss"], "huber");
  EXPECT_EQ(settings["loss_scale"], 0.02);
  EXPECT_EQ(settings["confidence"], 0.9);
  EXPECT_EQ(settings["weber_fraction"], 0.1);
  EXPECT_EQ(settings["threshold"], 0.04);
  EXPECT_EQ(fit["recordings"][0]["noise"], 0.01);
  EXPECT_EQ(fit["fits"][0]["options"]["segments"], 2.0);
}

TEST_F(ResultRoutes, HandOutALawForAnotherProgram) {
  const json hosts = json::parse(get("/api/laws/hosts").body);
  EXPECT_GE(hosts.size(), 7U);
  EXPECT_EQ(hosts[0]["name"], "c");
  const auto exported = [this](const std::string& host) {
    return get("/api/law/exported", {{"id", id("tissue.law.toml")}, {"host", host}});
  };
  const HttpResponse c = exported("c");
  ASSERT_EQ(c.status, 200) << c.body;
  EXPECT_THAT(c.body, HasSubstr("tissue"));
  EXPECT_EQ(c.type, "application/octet-stream");
  const HttpResponse unity = exported("unity");
  ASSERT_EQ(unity.status, 200) << unity.body;
  EXPECT_THAT(unity.body, testing::StartsWith(unity.type == "application/zip" ? "PK" : "//"));
  EXPECT_EQ(exported("c").body, c.body) << "the same law, the same bytes";
}

TEST_F(ResultRoutes, SayHowWellAFittedLawIsKnown) {
  const HttpResponse taken =
      post("/api/fit", {{"recording", id("punch.h5")}, {"axis", "z"}, {"models", {"kelvin"}}, {"folds", 2}});
  ASSERT_EQ(test::ended_job(jobs_, json::parse(taken.body)["job"])["state"], "done");
  const json left = json::parse(get("/api/residuals", {{"id", id("punch.h5")},
                                                       {"axis", "z"},
                                                       {"law", id("punch.fit/kelvin.law.toml")},
                                                       {"columns", "50"}})
                                    .body);
  ASSERT_TRUE(left.contains("interval")) << left;
  EXPECT_EQ(left["interval"]["confidence"], 0.95);
  EXPECT_EQ(left["interval"]["closing"].size(), left["penetration"].size());
}

TEST_F(ResultRoutes, SayWhichLawsHaveBreakpoints) {
  write_law_file(folder_ / "knots.law.toml",
                 {.law = models::Law::make("piecewise", std::vector{0.0, 1.0, 0.0, 2.0}, {{"segments", 1.0}}),
                  .axis = "z"});
  const json laws = json::parse(get("/api/workspace").body).at("laws");
  ASSERT_EQ(laws.size(), 2U);
  for (const json& one : laws) EXPECT_EQ(one.at("breakpoints"), one.at("model") == "piecewise") << one;
}

TEST_F(ResultRoutes, RefuseWhatIsNotAsItShouldBeInOneLine) {
  const std::string recording = id("punch.h5");
  const auto fit = [&](const json& more) {
    json body{{"recording", recording}};
    body.update(more);
    return post("/api/fit", body);
  };
  const auto map = [&](const json& more) {
    json body{{"device", "sim:scissors"}, {"rate_hz", 1000}, {"cells", 5}};
    body.update(more);
    return post("/api/stability", body);
  };
  const std::vector<std::pair<HttpResponse, std::string>> refused{
      {fit({{"recording", "../../etc/passwd"}}), "no such recording"},
      {fit({{"recording", id("tissue.law.toml")}}), "no such recording"},
      {fit({{"recording", 7}}), "recording"},
      {fit({{"models", {"magic"}}}), "magic"},
      {fit({{"models", "kelvin"}}), "models"},
      {fit({{"models", {1, 2}}}), "models"},
      {fit({{"folds", 101}}), "folds"},
      {fit({{"folds", 1}}), "folds"},
      {fit({{"folds", 2.5}}), "folds"},
      {fit({{"cycles", "2-"}}), "2-"},
      {fit({{"segments", "many"}}), "many"},
      {fit({{"profile", 1}}), "profile"},
      {fit({{"option", {"segments"}}}), "segments"},
      {fit({{"loss", "cubes"}}), "cubes"},
      {fit({{"jobs", 3}}), "no option 'jobs'"},
      {get("/api/law/exported", {{"id", id("tissue.law.toml")}, {"host", "lisp"}}),
       "no host 'lisp'; the hosts are c"},
      {get("/api/law/exported", {{"id", recording}, {"host", "c"}}), "no such law"},
      {post("/api/chart", {{"recording", recording}, {"models", {"blade"}}}), "blade"},
      {post("/api/choose", {{"recording", recording}, {"rate_hz", 5}}), "rate_hz"},
      {map({{"device", "falcon"}}), "sim:scissors"},
      {map({{"device", "/dev/hidraw0"}}), "sim:scissors"},
      {map({{"cells", 61}}), "cells"},
      {map({{"rate_hz", 1e9}}), "rate_hz"},
      {map({{"grip", "vice"}}), "vice"},
      {map({{"law", recording}}), "no such law"},
      {map({{"depth_m", -1.0}}), "depth_m"},
      {get("/api/result", {{"id", recording}}), "no such"},
      {get("/api/result"), "id"},
      {get("/api/law", {{"id", id("old.fit/fit.json")}}), "no such law"},
      {get("/api/residuals",
           {{"id", recording}, {"axis", "w"}, {"law", id("tissue.law.toml")}, {"columns", "5"}}),
       "no axis 'w'; it has z"},
      {get("/api/residuals",
           {{"id", recording}, {"axis", "z"}, {"law", id("tissue.law.toml")}, {"columns", "5000"}}),
       "columns"},
      {post("/api/jobs/stop", {{"job", -1}}), "job"},
  };
  for (const auto& [response, named] : refused) {
    EXPECT_THAT(response.status, testing::AnyOf(400, 404)) << response.body;
    const auto why = json::parse(response.body)["error"].get<std::string>();
    EXPECT_THAT(why, HasSubstr(named));
    EXPECT_EQ(std::count(why.begin(), why.end(), '\n'), 0) << why;
  }
  EXPECT_EQ(json::parse(get("/api/jobs").body).size(), 0U) << "a refused order is no job";
}

TEST_F(ResultRoutes, StopAJob) {
  const json order{{"recording", id("punch.h5")}, {"models", json::array()}};
  const std::size_t first = json::parse(post("/api/chart", order).body)["job"];
  const std::size_t second = json::parse(post("/api/chart", order).body)["job"];
  EXPECT_EQ(post("/api/jobs/stop", {{"job", second}}).status, 200);
  EXPECT_EQ(post("/api/jobs/stop", {{"job", first}}).status, 200);
  EXPECT_EQ(test::ended_job(jobs_, second)["state"], "stopped");
  EXPECT_EQ(test::ended_job(jobs_, first)["state"], "stopped");
}

TEST_F(ResultRoutes, AreNotSharedWithFilesThatCannotBeRead) {
  test::write_text(folder_ / "broken.law.toml", "model = ");
  const HttpResponse response = get("/api/law", {{"id", id("broken.law.toml")}});
  EXPECT_EQ(response.status, 400);
  EXPECT_THAT(response.body, HasSubstr("broken.law.toml:1"));
}

}  // namespace
}  // namespace kerf::bench

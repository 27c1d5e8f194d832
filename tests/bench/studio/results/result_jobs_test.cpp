#include "results/result_jobs.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/studio/jobs/finished_jobs.h"
#include "laws/law_file.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using test::ended_job;
using test::read_text;
using test::run_kerf;
using test::TemporaryFolder;
using testing::HasSubstr;

namespace fs = std::filesystem;

json file_of(const fs::path& file) { return json::parse(read_text(file)); }

/// Names in a folder, hidden ones too.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(folder)) names.push_back(file.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Two punches in a workspace, and jobs at work there.
class StudioResults : public testing::Test {
 protected:
  StudioResults() : recording_(folder_ / "punch.h5") {
    schema::write_recording(recording_, test::punch({.seconds = 2.0}));
  }

  WorkspaceEntry entry() { return workspace_.find(workspace_.id_of(recording_), FileKind::recording); }
  FitRequest fit_of(std::vector<std::string> models, std::size_t folds = 5) {
    FitRequest request{.recording = entry(), .asked = {}};
    request.asked.options.models = std::move(models);
    request.asked.options.fit.folds = folds;
    return request;
  }
  json run(JobOrder order) { return ended_job(jobs_, jobs_.add(std::move(order))); }
  /// What the verb writes into a folder outside of the workspace.
  json by_verb(std::vector<std::string> arguments, const std::string& file) {
    const std::string out = (elsewhere_ / "out").string();
    arguments.insert(arguments.end(), {"-o", out});
    const auto outcome = run_kerf(arguments);
    EXPECT_LT(outcome.exit_status, 2) << outcome.errors;
    return file_of(fs::path(out) / file);
  }

  TemporaryFolder folder_;
  TemporaryFolder elsewhere_;
  fs::path recording_;
  Workspace workspace_{folder_.path()};
  Jobs jobs_;
};

TEST_F(StudioResults, AFitIsWhatTheVerbWrites) {
  const json job = run(fit_job(workspace_, fit_of({"kelvin", "piecewise"})));
  ASSERT_EQ(job["state"], "done") << job["error"];
  EXPECT_EQ(job["title"], "Fit of punch.h5");
  EXPECT_EQ(job["file"], workspace_.id_of(folder_ / "punch.fit/fit.json"));
  json ours = file_of(folder_ / "punch.fit/fit.json");
  json verbs = by_verb({"fit", recording_.string(), "--models", "kelvin,piecewise"}, "fit.json");
  for (json* fits : {&ours, &verbs}) {
    for (json& fit : (*fits)["fits"]) fit.erase("seconds");
  }
  EXPECT_EQ(ours, verbs);
  EXPECT_EQ(names_in(folder_ / "punch.fit"), names_in(elsewhere_ / "out"));
  EXPECT_THAT(read_law_file(folder_ / "punch.fit/kelvin.law.toml").fit.recording_sha256, testing::SizeIs(64));
}

TEST_F(StudioResults, AChartIsWhatTheVerbWritesWithALawForEveryPoint) {
  const json job = run(chart_job(workspace_, {.recording = entry(), .models = {"kelvin"}}));
  ASSERT_EQ(job["state"], "done") << job["error"];
  const json ours = file_of(folder_ / "punch.chart/chart.json");
  const json verbs = by_verb({"chart", recording_.string(), "--laws", "kelvin"}, "chart.json");
  ASSERT_EQ(ours["points"].size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    for (const auto* same : {"law", "fidelity", "parameters", "law_file", "error_n", "worst_n", "stable"})
      EXPECT_EQ(ours["points"][i][same], verbs["points"][i][same]) << same;
    const fs::path law = folder_ / "punch.chart" / ours["points"][i]["law_file"].get<std::string>();
    EXPECT_EQ(read_law_file(law).law.model(), "kelvin");
    EXPECT_EQ(workspace_.find(workspace_.id_of(law), FileKind::law).kind, FileKind::law);
  }
  EXPECT_EQ(names_in(folder_ / "punch.chart/points"), names_in(elsewhere_ / "out/points"));
  EXPECT_THAT(ours["notes"].dump(), HasSubstr("beside a running studio"));
}

TEST_F(StudioResults, AChoiceIsWhatTheVerbWritesButForTheWallClock) {
  schema::write_recording(recording_, test::punch({.seconds = 0.4}));
  const json job = run(choice_job(workspace_, {.recording = entry(), .max_segments = 2}));
  ASSERT_EQ(job["state"], "done") << job["error"];
  const json ours = file_of(folder_ / "punch.choice/choose.json");
  const json verbs =
      by_verb({"choose", recording_.string(), "--no-loop", "--most-segments", "2"}, "choose.json");
  EXPECT_EQ(ours["recording"], "punch.h5");
  EXPECT_EQ(ours["jnd"], verbs["jnd"]);
  ASSERT_EQ(ours["candidates"].size(), verbs["candidates"].size());
  double max_parameters = 0.0;
  for (const json& candidate : ours["candidates"]) {
    EXPECT_TRUE(candidate["deadline"].is_null());
    max_parameters = std::max(max_parameters, candidate["parameters"].get<double>());
  }
  EXPECT_GT(max_parameters, 10.0);
  const auto law = ours["choice"]["law"].get<std::string>();
  EXPECT_TRUE(fs::exists(folder_ / ("punch.choice/" + law + ".law.toml")));
  EXPECT_THAT(ours["warnings"].dump(), HasSubstr("no law was run by the wall clock"));
}

TEST_F(StudioResults, AMapOfWallsIsWhatTheVerbWrites) {
  const json job = run(stability_job(workspace_, {.study = {.on = {.grip = "light"}, .cells = 6}}));
  ASSERT_EQ(job["state"], "done") << job["error"];
  const json ours = file_of(folder_ / "sim-scissors.stability/stability.json");
  EXPECT_EQ(ours, by_verb({"stability", "--grip", "light", "--cells", "6"}, "stability.json"));
  EXPECT_EQ(ours["cells"].size(), 36U);
  EXPECT_EQ(ours["boundaries"].size(), 6U);
  EXPECT_EQ(ours["on"]["device"], "sim:scissors");
  EXPECT_EQ(ours["on"]["rate_hz"], 1000.0);
  EXPECT_GT(ours["on"]["passive_stiffness_n_per_m"].get<double>(), 0.0);
}

TEST_F(StudioResults, AMapOfALawNamesItsFile) {
  const fs::path law = folder_ / "tissue.law.toml";
  write_law_file(law, {.law = models::Law::make("kelvin", std::vector{5.0, 8.0, 1.6}),
                       .contact = {.position = 0.5, .direction = -1.0},
                       .axis = "theta",
                       .position_unit = "rad"});
  const json job = run(stability_job(
      workspace_, {.law = workspace_.find(workspace_.id_of(law), FileKind::law), .study = {.cells = 3}}));
  ASSERT_EQ(job["state"], "done") << job["error"];
  const json map = file_of(folder_ / "tissue.stability/stability.json");
  EXPECT_EQ(map["law_file"], "tissue.law.toml");
  EXPECT_EQ(map["study"], "law");
  EXPECT_EQ(map["cells"].size(), 9U);
}

TEST_F(StudioResults, EarlierOnesStayUnderTheirNames) {
  const FitRequest kelvin = fit_of({"kelvin"}, 0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(run(fit_job(workspace_, kelvin))["state"], "done");
  EXPECT_THAT(names_in(folder_.path()),
              testing::ElementsAre("punch-2.fit", "punch-3.fit", "punch.fit", "punch.h5"));
}

TEST_F(StudioResults, WhatAKilledStudioLeftUnfinishedGoes) {
  constexpr auto nobody = "2147483647";  // is no process
  std::filesystem::create_directory(folder_ / (std::string("punch.chart.writing-") + nobody));
  EXPECT_EQ(run(fit_job(workspace_, fit_of({"kelvin"}, 0)))["state"], "done");
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("punch.fit", "punch.h5"));
}

TEST_F(StudioResults, NothingIsLeftOfOneThatFailedOrWasStopped) {
  FitRequest elsewhere = fit_of({});
  elsewhere.asked.axis = "theta";
  const json failed = run(fit_job(workspace_, elsewhere));
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_THAT(failed["error"].get<std::string>(), HasSubstr("no axis 'theta'; it has z"));
  for (JobOrder stopped :
       {fit_job(workspace_, {.recording = entry()}), chart_job(workspace_, {.recording = entry()}),
        choice_job(workspace_, {.recording = entry()}), stability_job(workspace_, {})}) {
    stopped.work = [work = stopped.work](JobProgress& progress) {
      progress.stop = true;
      return work(progress);
    };
    // As at the end of a studio: nobody has asked for this one.
    EXPECT_EQ(run(stopped)["state"], "interrupted");
  }
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("punch.h5"));
}

}  // namespace
}  // namespace kerf::bench

#include "cycles/cycle_routes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/studio/server/asker.h"
#include "recordings/provenance.h"
#include "segment/cycle_edit.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

/// Eight strokes of scissors, closing against 1 N more.
schema::Recording scissors(bool segmented = true) {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  for (int row = 0; row < 8000; ++row) {
    const double turn = std::numbers::pi * row / 500.0;
    recording.time.push_back(1e-3 * row);
    recording.tick.push_back(static_cast<std::uint64_t>(row));
    recording.position.push_back(0.25 * (1.0 - std::cos(turn)));
    recording.velocity.push_back(250.0 * std::numbers::pi / 500.0 * std::sin(turn));
    recording.force_measured.push_back(2.0 * recording.position.back() + (row / 500 % 2 == 0 ? 1.0 : 0.1));
  }
  if (segmented) segment_recording(recording, schema::RowsInMemory(recording), {}, "test");
  return recording;
}

class CycleRoutes : public testing::Test {
 protected:
  CycleRoutes() {
    schema::write_recording(file(), scissors());
    id_ = workspace_.id_of(file());
    add_cycle_routes(routes_, workspace_, views_);
  }

  [[nodiscard]] fs::path file() const { return folder_ / "cut.h5"; }
  json stored() { return json::parse(ask_.get("/api/cycles", {{"id", id_}}).body); }
  HttpResponse save(const json& view, const json& changes) {
    json body{{"recording", id_},
              {"version", view.at("version")},
              {"uuid", view.at("uuid")},
              {"author", "Anna"},
              {"axis", 0},
              {"said", view.at("said")},
              {"phases", plain(view.at("phases"))}};
    body.update(changes);
    return ask_.post("/api/cycles/save", body);
  }
  /// Without their times.
  static json plain(const json& phases) {
    json list = json::array();
    for (const json& phase : phases) list.push_back({phase[0], phase[1], phase[2], phase[3]});
    return list;
  }
  /// The phases with the begin of the closing of a cycle moved.
  static json moved(const json& view, int cycle, int by) {
    json phases = plain(view.at("phases"));
    for (std::size_t i = 1; i < phases.size(); ++i) {
      if (phases[i][0] != cycle || phases[i][1] != 3) continue;
      phases[i][2] = phases[i][2].get<int>() + by;
      phases[i - 1][3] = phases[i][2];
    }
    return phases;
  }

  test::TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  RecordingViews views_{ViewCache({})};
  std::string id_;
  Routes routes_;
  test::Asker ask_{routes_};
};

TEST_F(CycleRoutes, TellTheCyclesThatAreStored) {
  const json view = stored();
  EXPECT_EQ(view["stored"], true);
  EXPECT_EQ(view["cycles"].size(), 8U);
  EXPECT_EQ(view["phases"].size(), scissors().cycles->phases.size());
  EXPECT_EQ(view["phases"][1][4], 1e-3 * view["phases"][1][2].get<int>());
  EXPECT_EQ(view["locked"], "");
  EXPECT_EQ(view["average"]["position"].size(), 101U);
  EXPECT_TRUE(view["edits"].empty());
}

TEST_F(CycleRoutes, FindCyclesBySettingsAndKeepNothing) {
  const std::string before = test::read_text(file());
  const json found = json::parse(
      ask_.post("/api/cycles/look", {{"recording", id_},
                                     {"axis", 0},
                                     {"settings", {{"prominence", 0.9}, {"closing", "decreasing"}}},
                                     {"loop", 2}})
          .body);
  EXPECT_EQ(found["stored"], false);
  EXPECT_EQ(found["closing_direction"], -1.0);
  EXPECT_EQ(found["settings"]["prominence"], 0.9);
  EXPECT_GT(found["loop"]["position"].size(), 10U);
  EXPECT_EQ(test::read_text(file()), before);
  const json none = json::parse(
      ask_.post("/api/cycles/look",
                {{"recording", id_}, {"axis", 0}, {"settings", {{"prominence", 0.99}, {"corner_hz", 0.01}}}})
          .body);
  EXPECT_TRUE(none.contains("why_none")) << none;
  EXPECT_EQ(ask_.post("/api/cycles/look", {{"recording", id_}, {"settings", {{"prominence", 2.0}}}}).status,
            400);
}

TEST_F(CycleRoutes, KeepAnEditInTheRecordingWithItsAuthor) {
  const json view = stored();
  const auto answer = save(view, {{"phases", moved(view, 3, 25)},
                                  {"said", {{{"cycle", 5}, {"kind", "by_hand"}, {"reason", "slipped"}}}}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json after = json::parse(answer.body);
  EXPECT_NE(after["version"], view["version"]);
  EXPECT_EQ(after["edits"][0]["author"], "Anna");
  EXPECT_THAT(after["edits"][0]["what"].get<std::string>(), HasSubstr("cycle 3: closing begins at"));
  EXPECT_EQ(after["cycles"][4]["good"], false);
  const schema::Recording recording = schema::read_recording(file());
  EXPECT_EQ(recording.position, scissors().position) << "what was sampled stays";
  const json shown = json::parse(test::run_kerf({"info", file().string(), "--json"}).output);
  EXPECT_EQ(shown["cycles"]["edits"][0]["author"], "Anna");
  EXPECT_EQ(test::run_kerf({"validate", file().string()}).exit_status, 0);
  const json undone =
      json::parse(save(after, {{"phases", plain(view["phases"])}, {"said", json::array()}}).body);
  EXPECT_EQ(undone["phases"], view["phases"]);
  EXPECT_EQ(undone["average"], view["average"]) << "nothing is left of what was undone";
}

TEST_F(CycleRoutes, SplitAndMergeCycles) {
  const json view = stored();
  const auto look = [&](const json& phases, const json& step) {
    return ask_.post("/api/cycles/look",
                     {{"recording", id_}, {"axis", 0}, {"phases", plain(phases)}, {"step", step}});
  };
  const json merged = json::parse(look(view["phases"], {{"kind", "merge"}, {"cycle", 3}}).body);
  EXPECT_EQ(merged["cycles"].size(), 7U) << merged;
  EXPECT_EQ(stored()["cycles"].size(), 8U) << "nothing is kept";
  const json met = *std::ranges::find_if(view["phases"], [](const json& it) { return it[0] == 4; });
  const json split =
      json::parse(look(merged["phases"], {{"kind", "split"}, {"cycle", 3}, {"row", met[2]}}).body);
  EXPECT_EQ(split["cycles"].size(), 8U) << split;
  const json after = json::parse(save(view, {{"phases", plain(merged["phases"])}}).body);
  EXPECT_EQ(after["cycles"].size(), 7U) << after;
  EXPECT_THAT(after["edits"][0]["what"].get<std::string>(), HasSubstr("cycles 3 and 4, which met at"));
  const schema::Recording kept = schema::read_recording(file());
  ASSERT_EQ(kept.cycle_edits.size(), 1U);
  EXPECT_EQ(kept.cycle_edits[0].kind, "merged");
  EXPECT_EQ(kept.cycle_edits[0].author, "Anna");
  EXPECT_EQ(test::run_kerf({"validate", file().string()}).exit_status, 0);
  const json back = json::parse(save(after, {{"phases", plain(view["phases"])}}).body);
  EXPECT_EQ(back["phases"], view["phases"]) << "what was saved can be taken back";
  EXPECT_THAT(back["edits"][1]["what"].get<std::string>(), HasSubstr("cycle 3 split at"));
  const auto refused = look(view["phases"], {{"kind", "split"}, {"cycle", 3}, {"row", 1}});
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("cycle 3 has the rows"));
  EXPECT_EQ(look(view["phases"], {{"kind", "turn"}, {"cycle", 3}}).status, 400);
}

TEST_F(CycleRoutes, RefuseTheSecondOfTwoTabs) {
  const json both = stored();
  ASSERT_EQ(save(both, {{"phases", moved(both, 3, 25)}}).status, 200);
  const std::string kept = test::read_text(file());
  const auto second = save(both, {{"phases", moved(both, 4, 25)}, {"author", "Bo"}});
  EXPECT_EQ(second.status, 409);
  EXPECT_THAT(second.body, HasSubstr("Anna saved at"));
  EXPECT_EQ(test::read_text(file()), kept);
  const json theirs = stored();
  EXPECT_EQ(save(theirs, {{"phases", moved(theirs, 4, 25)}, {"author", "Bo"}}).status, 200);
  EXPECT_EQ(stored()["edits"].size(), 2U);
}

TEST_F(CycleRoutes, SayWhatHasHappenedToTheRecordingUnderneath) {
  const json view = stored();
  schema::write_recording(file(), scissors());  // another one of the same name
  const auto replaced = save(view, {{"phases", moved(view, 3, 25)}});
  EXPECT_EQ(replaced.status, 410);
  EXPECT_THAT(replaced.body, HasSubstr("Another recording has taken the place"));
  fs::remove(file());
  const auto removed = save(view, {{"phases", moved(view, 3, 25)}});
  EXPECT_EQ(removed.status, 404);
  EXPECT_THAT(removed.body, HasSubstr("no such recording in this folder any more"));
  test::write_text(file(), "no recording");
  EXPECT_EQ(ask_.get("/api/cycles", {{"id", id_}}).status, 404);
}

TEST_F(CycleRoutes, SayThatARecordingIsLocked) {
  if (geteuid() == 0) GTEST_SKIP() << "nothing is locked to root";
  const json view = stored();
  fs::permissions(file(), fs::perms::owner_read);
  EXPECT_THAT(stored()["locked"].get<std::string>(), HasSubstr("may not be written"));
  EXPECT_EQ(save(view, {{"phases", moved(view, 3, 25)}}).status, 423);
}

TEST_F(CycleRoutes, FindTheRowOfATime) {
  const auto row = [&](const std::string& time) {
    return json::parse(ask_.get("/api/cycles/row", {{"id", id_}, {"time", time}}).body);
  };
  EXPECT_EQ(row("0.0125")["row"], 13);
  EXPECT_EQ(row("0.0131")["time_s"], 1e-3 * 14);
  EXPECT_EQ(row("-5")["row"], 0);
  EXPECT_EQ(row("1e6")["row"], 7999);
}

TEST_F(CycleRoutes, TellAFitOfEarlierCycles) {
  const fs::path fits = folder_ / "cut.fit";
  ASSERT_EQ(
      test::run_kerf({"fit", file().string(), "--models", "kelvin", "--folds", "2", "-o", fits.string()})
          .exit_status,
      0);
  const std::string fit = workspace_.id_of(fits / "fit.json");
  const auto earlier = [&] {
    return json::parse(ask_.get("/api/cycles/fit", {{"id", id_}, {"fit", fit}}).body);
  };
  EXPECT_EQ(earlier()["earlier"], false);
  const json view = stored();
  ASSERT_EQ(save(view, {{"phases", moved(view, 3, 25)}}).status, 200);
  EXPECT_EQ(earlier()["earlier"], true);
  EXPECT_THAT(earlier()["why"].get<std::string>(), HasSubstr("Anna edited them"));
  test::replace_in(fits / "fit.json", "cycles_sha256", "cycles_unknown");
  EXPECT_EQ(earlier()["earlier"], nullptr) << "an earlier version did not say";
}

TEST_F(CycleRoutes, TellAFitFromBeforeCyclesWereSaved) {
  schema::write_recording(file(), scissors(false));
  const fs::path fits = folder_ / "cut.fit";
  ASSERT_EQ(
      test::run_kerf({"fit", file().string(), "--models", "kelvin", "--folds", "2", "-o", fits.string()})
          .exit_status,
      0);
  const std::string fit = workspace_.id_of(fits / "fit.json");
  const auto earlier = [&] {
    return json::parse(ask_.get("/api/cycles/fit", {{"id", id_}, {"fit", fit}}).body);
  };
  EXPECT_EQ(earlier()["earlier"], nullptr) << "there are none yet";
  const json view = stored();
  ASSERT_EQ(save(view, {{"phases", moved(view, 3, 25)}}).status, 200);
  EXPECT_EQ(earlier()["earlier"], true);
  EXPECT_THAT(earlier()["why"].get<std::string>(), HasSubstr("before cycles were saved"));
}

TEST_F(CycleRoutes, FindCyclesWhereNoneAreStored) {
  schema::write_recording(file(), scissors(false));
  const json view = stored();
  EXPECT_EQ(view["stored"], false);
  EXPECT_EQ(view["cycles"].size(), 8U);
  ASSERT_EQ(save(view, {{"settings", view["settings"]}}).status, 200);
  EXPECT_EQ(stored()["stored"], true);
  EXPECT_THAT(stored()["edits"][0]["what"].get<std::string>(), HasSubstr("found anew"));
}

}  // namespace
}  // namespace kerf::bench

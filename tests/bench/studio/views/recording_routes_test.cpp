#include "views/recording_routes.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/studio/views/long_recording.h"
#include "support/program.h"
#include "support/recordings.h"
#include "views/recording_inspection.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A recording behind the routes, under the id "a".
class ServedRecording {
 public:
  explicit ServedRecording(const schema::Recording& recording) {
    schema::write_recording(folder_ / "r.h5", recording);
    add_recording_routes(routes_, views_, [this](const std::string& id) {
      if (id != "a") throw RequestError(404, "no such file");
      return folder_ / "r.h5";
    });
  }
  HttpResponse get(const std::string& path, const std::map<std::string, std::string>& query) {
    const HttpRequest request{
        .number = ++number_, .method = "GET", .path = path, .query = query, .asker = asker_};
    auto response = routes_.respond(request, false);
    for (; !response; response = routes_.respond(request, false)) std::this_thread::yield();
    return *response;
  }
  json get_json(const std::string& path, const std::map<std::string, std::string>& query) {
    const HttpResponse response = get(path, query);
    EXPECT_EQ(response.status, 200) << response.body;
    EXPECT_EQ(response.type, "application/json");
    return json::parse(response.body);
  }

 private:
  test::TemporaryFolder folder_;
  RecordingViews views_{ViewCache({})};
  Routes routes_;
  std::shared_ptr<int> asker_ = std::make_shared<int>();
  std::uint64_t number_ = 0;
};

TEST(RecordingRoutes, TellWhatARecordingHolds) {
  schema::Recording rows = test::long_recording(1000);
  rows.events.assign(2500, {.time_s = 0.6, .kind = "stop", .text = "a \"word\""});
  rows.flags[10] = schema::flag_rows_lost;
  ServedRecording served(rows);
  const json about = served.get_json("/api/recording", {{"id", "a"}});
  EXPECT_EQ(about["id"], "a");
  EXPECT_EQ(about["rows"], 1000);
  EXPECT_NEAR(about["seconds"].get<double>(), 0.999, 1e-9);
  EXPECT_NEAR(about["from_s"].get<double>(), 0.501, 1e-9);
  EXPECT_NEAR(about["period_s"].get<double>(), 1e-3, 1e-9);
  EXPECT_EQ(about["status"], "complete");
  EXPECT_EQ(about["device"], "sim:scissors");
  EXPECT_EQ(about["axes"][1]["name"], "x_s");
  EXPECT_EQ(about["traces"][0]["name"], "position theta");
  EXPECT_EQ(about["traces"][0]["unit"], "rad");
  EXPECT_EQ(about["traces"][11]["name"], "grip \"µ\"");
  EXPECT_EQ(about["events"].size(), 2000U);
  EXPECT_EQ(about["events_in_all"], 2500);
  EXPECT_EQ(about["events"][0]["text"], "a \"word\"");
  EXPECT_EQ(about["gaps_in_all"], 1);
  EXPECT_EQ(about["gaps"][0][0], rows.time[9]);
  EXPECT_TRUE(about["cycles"].is_null());
}

TEST(RecordingRoutes, TellOfPhasesAsSpansOfTime) {
  schema::Recording rows = test::long_recording(9000);
  schema::Cycles cycles{.axis = 1, .closing_direction = -1.0, .contact_position = 0.25};
  cycles.phases = {{.cycle = 3, .phase = schema::Phase::closing, .begin = 10, .end = 8000},
                   {.cycle = 3, .phase = schema::Phase::opening, .begin = 8000, .end = 9001}};
  cycles.grid = {0.0, 1.0};
  cycles.closing_mean = cycles.opening_mean = {1.0, std::nan("")};
  rows.cycles = cycles;
  ServedRecording served(rows);
  const json about = served.get_json("/api/recording", {{"id", "a"}})["cycles"];
  EXPECT_EQ(about["axis"], 1);
  EXPECT_EQ(about["closing_direction"], -1.0);
  ASSERT_EQ(about["spans"].size(), 1U) << "the other has rows that are not there";
  EXPECT_EQ(about["spans"][0]["phase"], "closing");
  EXPECT_EQ(about["spans"][0]["from_s"], rows.time[10]);
  EXPECT_EQ(about["spans"][0]["to_s"], rows.time[7999]);
  const json loops =
      served.get_json("/api/recording/loops", {{"id", "a"}, {"axis", "1"}, {"first", "1"}, {"count", "9"}});
  EXPECT_EQ(loops["axis"], "x_s");
  EXPECT_EQ(loops["cycles_in_all"], 1);
  EXPECT_EQ(loops["segmented_here"], false);
  ASSERT_EQ(loops["loops"].size(), 1U);
  EXPECT_EQ(loops["loops"][0]["cycle"], 3);
  EXPECT_EQ(loops["loops"][0]["position"].size(), loops["loops"][0]["force"].size());
  EXPECT_EQ(loops["average"]["closing"], json::parse("[1, null]"));
}

TEST(RecordingRoutes, TellOfFlagsThatTheFileHas) {
  schema::Recording rows = test::long_recording(1000);
  rows.cycles = schema::Cycles{.axis = 0, .closing_direction = 1.0, .contact_position = 0.0};
  rows.cycles->phases = {{.cycle = 1, .phase = schema::Phase::closing, .begin = 0, .end = 1000}};
  EXPECT_TRUE(ServedRecording(rows).get_json("/api/recording", {{"id", "a"}})["cycles"]["flags"].is_null());
  rows.cycle_flags =
      schema::CycleFlags{.created = "2026-01-01T00:00:00Z",
                         .software = "kerf test",
                         .felt = 0.05,
                         .flags = {{.cycle = 1, .fault = "by_hand", .reason = "it slipped"},
                                   {.cycle = 1, .fault = "accepted", .reason = "it was meant to"}}};
  const json flags = ServedRecording(rows).get_json("/api/recording", {{"id", "a"}})["cycles"]["flags"];
  ASSERT_EQ(flags.size(), 2U);
  EXPECT_EQ(flags[0], json({{"cycle", 1}, {"kind", "by_hand"}, {"reason", "it slipped"}}));
  EXPECT_EQ(flags[1]["kind"], "accepted");
}

TEST(RecordingRoutes, SayWhatARecordingIsWorthAsTheVerbDoes) {
  const schema::Recording rows = test::punch({.noise_n = 0.02, .limit_n = 2.0});
  ServedRecording served(rows);
  const json found = served.get_json("/api/recording/inspection", {{"id", "a"}});
  EXPECT_EQ(found["why_none"], "");
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", rows);
  const json verb = json::parse(test::run_kerf({"inspect", (folder / "r.h5").string(), "--json"}).output);
  for (const auto& [name, value] : found["inspection"].items()) EXPECT_EQ(value, verb[name]) << name;
  const json& most = verb["signals"]["force_measured"]["most"];
  ASSERT_EQ(most["clipped"], true);
  ASSERT_EQ(found["clipped"].size(), most["first_runs"].size());
  const auto first = most["first_runs"][0]["first_row"].get<std::size_t>();
  const auto count = most["first_runs"][0]["rows"].get<std::size_t>();
  EXPECT_EQ(found["clipped"][0]["signal"], "force_measured");
  EXPECT_EQ(found["clipped"][0]["value"], 2.0);
  EXPECT_EQ(found["clipped"][0]["rows"], count);
  EXPECT_EQ(found["clipped"][0]["from_s"], rows.time[first]);
  EXPECT_EQ(found["clipped"][0]["to_s"], rows.time[first + count - 1]);
}

TEST(RecordingRoutes, LeaveALongRecordingToTheVerb) {
  schema::Recording rows;
  rows.header = schema::new_header("kerf test");
  rows.axes = {schema::Axis{}};
  const std::size_t count = max_rows_inspected + 1;
  for (std::size_t i = 0; i < count; ++i) {
    rows.time.push_back(1e-3 * static_cast<double>(i));
    rows.tick.push_back(i);
  }
  rows.position.assign(count, 0.0);
  rows.velocity.assign(count, 0.0);
  const json found = ServedRecording(rows).get_json("/api/recording/inspection", {{"id", "a"}});
  EXPECT_TRUE(found["inspection"].is_null());
  EXPECT_TRUE(found["clipped"].is_null());
  EXPECT_THAT(found["why_none"].get<std::string>(), HasSubstr("'kerf inspect'"));
}

TEST(RecordingRoutes, GiveAStretchAsBytes) {
  ServedRecording served(test::long_recording(1000));
  const HttpResponse response =
      served.get("/api/recording/view",
                 {{"id", "a"}, {"traces", "0,11"}, {"from", "0.6"}, {"to", "0.7"}, {"columns", "30"}});
  ASSERT_EQ(response.status, 200) << response.body;
  ASSERT_EQ(response.body.size(), 32U + 30U * 8U + 2U * 2U * 30U * 4U);
  std::uint32_t columns = 0;
  std::memcpy(&columns, response.body.data(), sizeof columns);
  EXPECT_EQ(columns, 30U);
}

TEST(RecordingRoutes, SayWhyThereAreNoLoops) {
  ServedRecording served(test::long_recording(5));
  const json loops =
      served.get_json("/api/recording/loops", {{"id", "a"}, {"axis", "0"}, {"first", "1"}, {"count", "9"}});
  EXPECT_EQ(loops["cycles_in_all"], 0);
  EXPECT_TRUE(loops["loops"].empty());
  EXPECT_THAT(loops["reason"].get<std::string>(), HasSubstr("too short"));
}

TEST(RecordingRoutes, HaveNoPictureOfWhatIsGoneWithoutAComplaint) {
  ServedRecording served(test::punch({.seconds = 0.5}));
  EXPECT_EQ(served.get("/api/recording/thumbnail", {{"id", "gone"}}).status, 200);
  EXPECT_TRUE(served.get_json("/api/recording/thumbnail", {{"id", "gone"}}).is_null());
  EXPECT_FALSE(served.get_json("/api/recording/thumbnail", {{"id", "a"}}).is_null());
}

TEST(RecordingRoutes, RefuseWhatCannotBeShown) {
  ServedRecording served(test::long_recording(100));
  EXPECT_EQ(served.get("/api/recording", {{"id", "b"}}).status, 404);
  EXPECT_EQ(served.get("/api/recording", {}).status, 400);
  const std::map<std::string, std::string> good{
      {"id", "a"}, {"traces", "0"}, {"from", "0"}, {"to", "1"}, {"columns", "10"}};
  EXPECT_EQ(served.get("/api/recording/view", good).status, 200);
  std::string many = "0";
  for (int i = 0; i < 32; ++i) many += ",0";
  for (const auto& [name, value] : std::map<std::string, std::string>{
           {"traces", "12"}, {"traces ", ""}, {"from", "nan"}, {"to", "x"}, {"columns", "4001"}}) {
    auto query = good;
    query[name == "traces " ? "traces" : name] = name == "traces " ? many : value;
    EXPECT_EQ(served.get("/api/recording/view", query).status, 400) << name;
  }
  EXPECT_EQ(
      served.get("/api/recording/loops", {{"id", "a"}, {"axis", "2"}, {"first", "1"}, {"count", "1"}}).status,
      400);
}

}  // namespace
}  // namespace kerf::bench

#include "live/live_routes.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "live/live_event.h"
#include "support/kelvin_law.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const char* const law_text = test::kelvin_law;

TEST(LiveFrame, IsJsonWithSixDigitsAndNullWhereNothingIs) {
  const LiveFrame frame{.from = 120,
                        .ticks_per_column = 2,
                        .columns = 2,
                        .smallest = {1.0 / 3.0, std::numeric_limits<double>::quiet_NaN(), -1.5e-7, 0.0},
                        .largest = {12345678.0, std::numeric_limits<double>::quiet_NaN(), 1e300, 2.0},
                        .events = {{.time_s = 0.12, .kind = "law", .text = "\"a\""}},
                        .next = 124};
  EXPECT_EQ(to_json(frame, 2, 3, 1e-3),
            R"({"run":3,"from":120,"ticks":2,"period_s":0.001,"smallest":[[0.333333,null],[-1.5e-07,0]],)"
            R"("largest":[[1.23457e+07,null],[1e+300,2]],)"
            R"("events":[{"time_s":0.12,"kind":"law","text":"\"a\""}]})");
  EXPECT_TRUE(json::accept(to_json({.columns = 0}, 3, 1, 1e-3)));
}

/// The routes of a loop, asked as a browser would.
struct LiveSite {
  test::TemporaryFolder folder;
  LiveLoop loop;
  bool is_session = false;
  Routes routes;
  std::shared_ptr<int> asker = std::make_shared<int>();
  std::uint64_t requests = 0;

  LiveSite() {
    add_live_routes(routes, loop,
                    {.uri_of = [](const std::string& uri) { return uri; },
                     .law_of =
                         [](const std::string& id) {
                           if (id != "abc") throw RequestError(404, "There is no such law.");
                           return parse_law_file(law_text, "a.law.toml");
                         },
                     .law_name_of = [](const std::string&) { return "a.law.toml"; },
                     .scene_of = {},
                     .new_recording = [this](const std::string& name) { return folder / (name + ".h5"); },
                     .is_closed = [this] { return is_session; }});
  }

  HttpResponse ask(const std::string& method, const std::string& path, const std::string& body = "",
                   std::map<std::string, std::string> query = {}) {
    const HttpRequest request{.number = ++requests,
                              .method = method,
                              .path = "/api/live/" + path,
                              .query = std::move(query),
                              .headers = {{"content-type", "application/json"}},
                              .body = body,
                              .asker = asker};
    for (;;) {
      if (auto response = routes.respond(request, false)) return *response;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  json status() { return json::parse(ask("GET", "status").body); }
  bool comes_true(const std::function<bool(const json&)>& condition) {
    for (int tries = 0; tries < 6000; ++tries) {
      if (condition(status())) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
};

TEST(LiveRoutes, StartSteerRecordAndStopALoop) {
  LiveSite site;
  EXPECT_EQ(site.status()["running"], false);
  EXPECT_EQ(site.ask("GET", "traces").body, "[]");
  EXPECT_EQ(site.ask("POST", "feel", "{}").status, 409) << "no loop runs";
  EXPECT_EQ(site.ask("GET", "view", "", {{"traces", "0"}}).status, 409);
  ASSERT_EQ(site.ask("POST", "start", R"({"device": "sim:scissors?seed=3", "sensor": ""})").status, 200);
  EXPECT_EQ(site.ask("POST", "start", "{}").status, 409) << "it runs already";
  EXPECT_EQ(site.ask("POST", "feel", R"({"law": "abc"})").status, 200);
  ASSERT_TRUE(site.comes_true([](const json& it) { return it["law"] == "a.law.toml"; }));
  EXPECT_EQ(site.ask("POST", "feel", R"({"law": "xyz"})").status, 404);
  EXPECT_EQ(site.ask("POST", "record", R"({"name": "cut"})").status, 200);
  ASSERT_TRUE(site.comes_true(
      [](const json& it) { return !it["recording"].is_null() && it["recording"]["rows"] > 50; }));
  EXPECT_EQ(site.status()["recording"]["name"], "cut.h5");
  const HttpResponse wrong = site.ask("POST", "feel", R"({"toml": "model = \"kelvin\""})");
  EXPECT_EQ(wrong.status, 400);
  EXPECT_THAT(wrong.body, HasSubstr("error"));
  EXPECT_EQ(site.ask("POST", "feel", json{{"toml", law_text}}.dump()).status, 200);
  ASSERT_TRUE(
      site.comes_true([](const json& it) { return it["law"] == "kelvin" && it["blending"] == false; }));
  EXPECT_EQ(site.ask("POST", "feel", "{}").status, 200);
  ASSERT_TRUE(site.comes_true([](const json& it) { return it["law"] == ""; }));
  EXPECT_EQ(site.ask("POST", "record/stop", "{}").status, 200);
  EXPECT_TRUE(std::filesystem::exists(site.folder / "cut.h5"));
  EXPECT_EQ(site.ask("POST", "record", R"({"name": "cut"})").status, 400) << "the file is there";

  const json traces = json::parse(site.ask("GET", "traces").body);
  EXPECT_EQ(traces[0], (json{{"name", "position theta"}, {"unit", "rad"}, {"group", "position"}}));
  const HttpResponse view =
      site.ask("GET", "view", "", {{"traces", "0,1"}, {"from", "0"}, {"to", "1"}, {"columns", "20"}});
  EXPECT_EQ(view.body.size(), 32U + 20 * 8 + 2 * 2 * 20 * 4);
  EXPECT_EQ(
      site.ask("GET", "view", "", {{"traces", "99"}, {"from", "0"}, {"to", "1"}, {"columns", "9"}}).status,
      400);
  EXPECT_EQ(site.ask("POST", "stop", "{}").status, 200);
  EXPECT_TRUE(site.comes_true([](const json& it) { return it["running"] == false; }));
}

TEST(LiveRoutes, AnswerZeroForceAtOnceWhateverIsGoingOn) {
  LiveSite site;
  for (const bool is_session : {false, true}) {
    site.is_session = is_session;
    site.loop.resume();
    // No header, no body that means anything: answered in the very first call.
    const auto response = site.routes.respond({.number = 100U + is_session,
                                               .method = "POST",
                                               .path = "/api/live/zero",
                                               .body = "{",
                                               .asker = site.asker},
                                              false);
    ASSERT_TRUE(response);
    EXPECT_EQ(response->status, 200);
    EXPECT_TRUE(site.loop.status().is_released);
  }
  site.is_session = false;
  EXPECT_EQ(site.status()["released"], true);
  EXPECT_EQ(site.ask("POST", "resume", "{}").status, 200);
  EXPECT_EQ(site.status()["released"], false);
}

TEST(LiveRoutes, RefuseALawThatIsForAnotherAxisThanTheDeviceHas) {
  LiveSite site;
  ASSERT_EQ(site.ask("POST", "start", R"({"device": "sim:scissors"})").status, 200);
  ASSERT_EQ(site.ask("POST", "feel", R"({"law": "abc"})").status, 200);
  ASSERT_TRUE(site.comes_true([](const json& it) { return it["law"] == "a.law.toml"; }));
  std::string punch = law_text;  // in m along an axis of its own, and x_s of the scissors is in m
  for (const auto& [from, to] : {std::pair{"\"theta\"", "\"punch\""}, std::pair{"\"rad\"", "\"m\""},
                                 std::pair{"30, unit = \"deg\"", "30, unit = \"mm\""}})
    punch.replace(punch.find(from), std::string(from).size(), to);
  for (std::size_t at = punch.find("/rad"); at != std::string::npos; at = punch.find("/rad"))
    punch.replace(at, 4, "/m");
  const HttpResponse refused = site.ask("POST", "feel", json{{"toml", punch}}.dump());
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("the law is for axis 'punch' (N over m)"));
  EXPECT_THAT(refused.body, HasSubstr("'theta' (N over rad)"));
  EXPECT_EQ(site.status()["law"], "a.law.toml");
}

TEST(LiveRoutes, SayInOneWordWhatThereIsOfForce) {
  LiveSite site;
  EXPECT_EQ(site.status()["force"], "idle");
  ASSERT_EQ(site.ask("POST", "start", R"({"device": "sim:scissors"})").status, 200);
  EXPECT_EQ(site.status()["force"], "free");
  ASSERT_EQ(site.ask("POST", "feel", R"({"law": "abc"})").status, 200);
  EXPECT_TRUE(site.comes_true([](const json& it) { return it["force"] == "rendered"; }));
  EXPECT_EQ(site.ask("POST", "zero").status, 200);
  EXPECT_EQ(site.status()["force"], "zero");
  site.is_session = true;
  EXPECT_EQ(site.status()["force"], "zero") << "whoever asked for it has to see that it is held";
  site.is_session = false;
  EXPECT_EQ(site.ask("POST", "resume", "{}").status, 200);
  EXPECT_EQ(site.status()["force"], "rendered");
  site.is_session = true;
  EXPECT_EQ(site.status()["force"], "session");
}

TEST(LiveRoutes, HoldZeroAfterAJumpUntilSomebodyConfirms) {
  LiveSite site;
  ASSERT_EQ(site.ask("POST", "confirm", "{}").status, 200) << "confirms nothing that is to come";
  ASSERT_EQ(site.ask("POST", "start", R"({"device": "sim:scissors?fault=jump@0.1:20mm"})").status, 200);
  ASSERT_EQ(site.ask("POST", "feel", R"({"law": "abc"})").status, 200);
  ASSERT_TRUE(site.comes_true([](const json& it) { return it["force"] == "held"; }));
  EXPECT_EQ(site.status()["force_reason"], "the position has jumped");
  EXPECT_EQ(site.ask("POST", "resume", "{}").status, 200);
  EXPECT_EQ(site.status()["force"], "held") << "nobody has looked where the tool is";
  EXPECT_EQ(site.ask("POST", "confirm", "{}").status, 200);
  EXPECT_TRUE(site.comes_true([](const json& it) { return it["force"] == "rendered"; }));
}

TEST(LiveRoutes, TellOfALostDeviceUntilItIsDismissedOrAnotherLoopStarts) {
  LiveSite site;
  const auto lose = [&] {
    ASSERT_EQ(site.ask("POST", "start", R"({"device": "sim:scissors?fault=unplug@0.05"})").status, 200);
    EXPECT_EQ(site.status()["force_reason"], "");
    ASSERT_TRUE(site.comes_true([](const json& it) { return it["force"] == "lost"; }));
    EXPECT_THAT(site.status()["force_reason"].get<std::string>(), HasSubstr("the device was lost"));
  };
  lose();
  EXPECT_EQ(site.ask("POST", "dismiss", "{}").status, 200);
  EXPECT_EQ(site.status()["force"], "idle");
  lose();
  ASSERT_EQ(site.ask("POST", "start", R"({"device": "sim:scissors"})").status, 200);
  EXPECT_EQ(site.status()["force"], "free");
}

TEST(LiveRoutes, ShowNothingOfTheLoopWhileASessionRuns) {
  LiveSite site;
  ASSERT_EQ(site.ask("POST", "start", "{}").status, 200);
  const HttpResponse stream = site.ask("GET", "stream", "", {{"ticks", "1"}});
  site.is_session = true;
  for (const char* path : {"traces", "stream", "view"}) EXPECT_EQ(site.ask("GET", path).status, 409) << path;
  for (const char* path :
       {"start", "stop", "feel", "resume", "confirm", "dismiss", "record", "record/stop"}) {
    const HttpResponse response = site.ask("POST", path, "{}");
    EXPECT_EQ(response.status, 409) << path;
    EXPECT_THAT(response.body, HasSubstr("A session is running; nothing of the loop is shown."));
  }
  const json status = site.status();
  EXPECT_EQ(status["session"], true);
  EXPECT_EQ(status["running"], false);
  EXPECT_EQ(status["device"], "");
  for (int call = 0; call < 40; ++call) {
    const std::string text = stream.more();
    EXPECT_TRUE(text.empty() || text.find(R"("session":true)") != std::string::npos);
  }
}

TEST(LiveRoutes, StreamFramesInOrderAndTheStatusBetweenThem) {
  LiveSite site;
  ASSERT_EQ(site.ask("POST", "start", "{}").status, 200);
  EXPECT_EQ(site.ask("GET", "stream", "", {{"ticks", "0"}}).status, 400);
  const HttpResponse stream = site.ask("GET", "stream", "", {{"ticks", "5"}});
  EXPECT_EQ(stream.type, "text/event-stream");
  EXPECT_THAT(stream.body, HasSubstr("event: status\ndata: {\"running\":true"));
  std::uint64_t next = 0;
  int frames = 0;
  int states = 0;
  for (int tries = 0; (frames < 10 || states < 2) && tries < 20'000; ++tries) {
    const std::string text = stream.more();
    if (text.empty()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } else if (text.starts_with("event: status\ndata: ")) {
      ++states;
    } else {
      ASSERT_TRUE(text.starts_with("event: frame\ndata: ") && text.ends_with("}\n\n")) << text;
      const json frame = json::parse(text.substr(19));
      EXPECT_EQ(frame["from"], next);
      EXPECT_EQ(frame["ticks"], 5);
      EXPECT_EQ(frame["period_s"], 0.001);
      const std::size_t columns = frame["smallest"][0].size();
      EXPECT_EQ(frame["smallest"].size(), site.loop.watched().history().traces().size());
      next += 5 * columns;
      ++frames;
    }
  }
  EXPECT_GE(frames, 10);
  EXPECT_GE(states, 2);
}

TEST(LiveRoutes, BeginTheStreamAnewWithAnotherLoop) {
  LiveSite site;
  LiveCursor cursor{.tick = 1'000'000, .calls = 1, .run = 7};
  ASSERT_EQ(site.ask("POST", "start", "{}").status, 200);
  ASSERT_TRUE(site.comes_true([](const json& it) { return it["ticks"] > 50; }));
  const std::string text = live_event(site.loop, cursor);
  EXPECT_THAT(text, HasSubstr(R"({"run":1,"from":0,)"));
  EXPECT_EQ(cursor.run, 1U);
}

}  // namespace
}  // namespace kerf::bench

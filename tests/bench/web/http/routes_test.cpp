#include "http/routes.h"

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::HasSubstr;

HttpRequest asking(const std::string& method, const std::string& path, const std::shared_ptr<int>& asker,
                   std::uint64_t number = 1) {
  return {.number = number, .method = method, .path = path, .asker = asker};
}

/// What comes of a slow request, asked again and again as the server does.
HttpResponse waited_for(Routes& routes, const HttpRequest& request) {
  auto response = routes.respond(request, false);
  while (!response) {
    std::this_thread::yield();
    response = routes.respond(request, false);
  }
  return *response;
}

TEST(Routes, AnswerByPathAndMethod) {
  Routes routes;
  const auto asker = std::make_shared<int>();
  routes.get("/a", Routes::Pace::at_once, [](const HttpRequest&) { return HttpResponse{.body = "get"}; });
  routes.post("/a", Routes::Pace::at_once, [](const HttpRequest&) { return HttpResponse{.body = "post"}; });
  EXPECT_EQ(routes.respond(asking("GET", "/a", asker), false)->body, "get");
  EXPECT_EQ(routes.respond(asking("POST", "/a", asker), false)->body, "post");
  EXPECT_EQ(routes.respond(asking("PUT", "/a", asker), false)->status, 405);
  for (const char* path : {"/b", "/a/", "/", "/a/../a", "//a"})
    EXPECT_EQ(routes.respond(asking("GET", path, asker), false)->status, 404) << path;
}

TEST(Routes, AnswerSlowlyFromAnotherThreadAndAtOnceMeanwhile) {
  std::atomic<bool> go{false};
  std::atomic<int> wakes{0};
  Routes routes;  // ends before what its threads look at
  routes.on_ready([&] { ++wakes; });
  routes.get("/slow", Routes::Pace::slow, [&](const HttpRequest&) {
    while (!go) std::this_thread::yield();
    return HttpResponse{.body = "done"};
  });
  routes.post("/zero", Routes::Pace::at_once,
              [](const HttpRequest&) { return HttpResponse{.body = "zero"}; });
  const auto asker = std::make_shared<int>();
  EXPECT_FALSE(routes.respond(asking("GET", "/slow", asker), false));
  EXPECT_EQ(routes.respond(asking("POST", "/zero", asker, 2), false)->body, "zero");
  EXPECT_FALSE(routes.respond(asking("GET", "/slow", asker), false));
  go = true;
  EXPECT_EQ(waited_for(routes, asking("GET", "/slow", asker)).body, "done");
  EXPECT_EQ(wakes, 1);
}

TEST(Routes, ActWhileSomethingSlowIsBeingAnswered) {
  std::atomic<bool> go{false};
  Routes routes;  // ends before what its threads look at
  routes.get("/slow", Routes::Pace::slow, [&](const HttpRequest&) {
    while (!go) std::this_thread::yield();
    return HttpResponse{.body = "done"};
  });
  routes.post("/act", Routes::Pace::action, [](const HttpRequest&) { return HttpResponse{.body = "acted"}; });
  const auto asker = std::make_shared<int>();
  EXPECT_FALSE(routes.respond(asking("GET", "/slow", asker, 1), false));
  EXPECT_EQ(waited_for(routes, asking("POST", "/act", asker, 2)).body, "acted");
  go = true;
  EXPECT_EQ(waited_for(routes, asking("GET", "/slow", asker, 1)).body, "done");
}

TEST(Routes, StopAJobWhileADeviceIsBeingOpenedAndAFileRead) {
  std::atomic<bool> go{false};
  Routes routes;  // ends before what its threads look at
  const auto waits = [&](const HttpRequest&) {
    while (!go) std::this_thread::yield();
    return HttpResponse{.body = "done"};
  };
  routes.get("/read", Routes::Pace::slow, waits);
  routes.post("/open", Routes::Pace::action, waits);
  routes.post("/stop", Routes::Pace::stop,
              [](const HttpRequest&) { return HttpResponse{.body = "stopped"}; });
  const auto asker = std::make_shared<int>();
  EXPECT_FALSE(routes.respond(asking("GET", "/read", asker, 1), false));
  EXPECT_FALSE(routes.respond(asking("POST", "/open", asker, 2), false));
  EXPECT_EQ(waited_for(routes, asking("POST", "/stop", asker, 3)).body, "stopped");
  go = true;
  EXPECT_EQ(waited_for(routes, asking("GET", "/read", asker, 1)).body, "done");
  EXPECT_EQ(waited_for(routes, asking("POST", "/open", asker, 2)).body, "done");
}

TEST(Routes, DoNotDoLaterWhatWasRefusedAsOverdue) {
  std::atomic<bool> go{false};
  std::atomic<int> done{0};
  Routes routes;  // ends before what its threads look at
  routes.post("/act", Routes::Pace::action, [&](const HttpRequest&) {
    while (!go) std::this_thread::yield();
    ++done;
    return HttpResponse{};
  });
  const auto asker = std::make_shared<int>();
  EXPECT_FALSE(routes.respond(asking("POST", "/act", asker, 1), false));
  EXPECT_FALSE(routes.respond(asking("POST", "/act", asker, 2), false));
  EXPECT_FALSE(routes.respond(asking("POST", "/act", asker, 3), false));
  EXPECT_EQ(routes.respond(asking("POST", "/act", asker, 2), true)->status, 503);
  go = true;
  EXPECT_EQ(waited_for(routes, asking("POST", "/act", asker, 3)).status, 200);
  EXPECT_EQ(done, 2);
}

TEST(Routes, DoNotBeginWhatNobodyWaitsFor) {
  std::atomic<bool> go{false};
  std::atomic<int> answered{0};
  Routes routes;  // ends before what its threads look at
  routes.get("/slow", Routes::Pace::slow, [&](const HttpRequest&) {
    while (!go) std::this_thread::yield();
    ++answered;
    return HttpResponse{};
  });
  const auto stays = std::make_shared<int>();
  (void)routes.respond(asking("GET", "/slow", stays, 1), false);
  // Many more than may wait, each given up at once, as by somebody who pans.
  for (std::uint64_t number = 2; number < 500; ++number) {
    const auto leaves = std::make_shared<int>();
    EXPECT_FALSE(routes.respond(asking("GET", "/slow", leaves, number), false));
  }
  EXPECT_FALSE(routes.respond(asking("GET", "/slow", stays, 500), false));
  go = true;
  EXPECT_EQ(waited_for(routes, asking("GET", "/slow", stays, 500)).status, 200);
  EXPECT_LE(answered, 3);
}

TEST(Routes, RefuseMoreThanTheyCanDo) {
  std::atomic<bool> go{false};
  Routes routes;  // ends before what its threads look at
  routes.get("/slow", Routes::Pace::slow, [&](const HttpRequest&) {
    while (!go) std::this_thread::yield();
    return HttpResponse{};
  });
  const auto asker = std::make_shared<int>();
  for (std::uint64_t number = 1; number <= 64; ++number)
    EXPECT_FALSE(routes.respond(asking("GET", "/slow", asker, number), false));
  EXPECT_EQ(routes.respond(asking("GET", "/slow", asker, 65), false)->status, 503);
  EXPECT_EQ(routes.respond(asking("GET", "/slow", asker, 64), true)->status, 503);
  go = true;
}

TEST(Routes, SayWhatWasWrongInTheAnswer) {
  Routes routes;
  const auto asker = std::make_shared<int>();
  const auto answer_to = [&](const std::string& path, auto thrown) {
    routes.get(path, Routes::Pace::at_once, [thrown](const HttpRequest&) -> HttpResponse { throw thrown; });
    return *routes.respond(asking("GET", path, asker), false);
  };
  EXPECT_EQ(answer_to("/a", RequestError(409, "not \"now\"")).body, R"({"error":"not \"now\""})");
  EXPECT_EQ(answer_to("/b", RequestError(409, "")).status, 409);
  EXPECT_EQ(answer_to("/c", std::invalid_argument("x")).status, 400);
  EXPECT_EQ(answer_to("/d", std::runtime_error("x")).status, 500);
  EXPECT_EQ(answer_to("/e", std::runtime_error("\xff")).status, 500);
}

TEST(Routes, ShowWhatWouldReorderALine) {
  EXPECT_EQ(json_response({{"name", "a\u202E\x1b"}}).body, R"({"name":"a\\u202e\\u001b"})");
  EXPECT_EQ(json_error(400, "\u2066").body, R"({"error":"\\u2066"})");
}

TEST(RequestValues, AreChecked) {
  const HttpRequest request{.query = {{"n", "12"}, {"x", "-1.5e3"}, {"list", "1,2,3"}, {"empty", ""}}};
  EXPECT_EQ(count_in_query(request, "n", 12), 12U);
  EXPECT_EQ(number_in_query(request, "x", -2000.0, 0.0), -1500.0);
  EXPECT_EQ(counts_in_query(request, "list", 3), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_THROW((void)count_in_query(request, "n", 11), RequestError);
  EXPECT_THROW((void)count_in_query(request, "x", 11), RequestError);
  EXPECT_THROW((void)count_in_query(request, "empty", 11), RequestError);
  EXPECT_THROW((void)number_in_query(request, "x", 0.0, 1.0), RequestError);
  EXPECT_THROW((void)counts_in_query(request, "list", 2), RequestError);
  EXPECT_THROW((void)counts_in_query(request, "empty", 2), RequestError);
  EXPECT_THROW((void)text_in_query(request, "none"), RequestError);
  for (const char* number : {"nan", "inf", "1e999", "1 ", " 1", "0x1", "../1", "1,"}) {
    EXPECT_THROW((void)number_in_query({.query = {{"x", number}}}, "x", -1e9, 1e9), RequestError) << number;
  }
}

TEST(RequestValues, OfABodyAreChecked) {
  const auto with = [](const std::string& type, const std::string& body) {
    return json_in({.headers = {{"content-type", type}}, .body = body});
  };
  const nlohmann::json json =
      with("application/json", R"({"name": "cut", "n": 2, "values": [1, 2.5], "on": true, "bad": [1, "2"]})");
  EXPECT_EQ(text_in(json, "name"), "cut");
  EXPECT_EQ(number_in(json, "n", 0.0, 2.0), 2.0);
  EXPECT_EQ(numbers_in(json, "values", 2), (std::vector<double>{1.0, 2.5}));
  EXPECT_TRUE(flag_in(json, "on", false));
  EXPECT_TRUE(flag_in(json, "none", true));
  EXPECT_THROW((void)text_in(json, "n"), RequestError);
  EXPECT_THROW((void)number_in(json, "n", 0.0, 1.0), RequestError);
  EXPECT_THROW((void)numbers_in(json, "values", 1), RequestError);
  EXPECT_THROW((void)numbers_in(json, "bad", 5), RequestError);
  EXPECT_THROW((void)flag_in(json, "n", true), RequestError);
  EXPECT_THROW((void)text_in(json, "none"), RequestError);
  for (const char* body : {"", "[]", "1", "{", R"({"a": 1} x)"})
    EXPECT_THROW((void)with("application/json", body), RequestError) << body;
  try {
    (void)with("text/plain", "{}");
    ADD_FAILURE();
  } catch (const RequestError& error) {
    EXPECT_EQ(error.status, 415);
  }
}

}  // namespace
}  // namespace kerf::bench

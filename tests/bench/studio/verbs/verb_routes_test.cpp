#include "verbs/verb_routes.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/studio/jobs/finished_jobs.h"
#include "jobs/job_routes.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using test::TemporaryFolder;
using testing::HasSubstr;

/// A studio whose program is a shell script in the folder of the test.
class VerbRoutes : public testing::Test {
 protected:
  VerbRoutes() {
    const auto script = programs_ / "kerf";
    test::write_text(
        script,
        "#!/bin/sh\n"
        "echo \"$@\"\n"
        "case \"$1\" in\n"
        "  make) mkdir out.d; echo '<svg/>' > out.d/a.svg; echo 'a,b' > out.d/t.csv; echo x > out.d/x.bin;;\n"
        "  fail) echo 'warning: odd' >&2; echo 'kerf: it is not there; look again' >&2; exit 2;;\n"
        "  judge) exit 1;;\n"
        "  die) kill -9 $$;;\n"
        "  wait) echo '1 4' >&3; sleep 60;;\n"
        "esac\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    VerbProgram program{.program = script, .key_file = programs_ / "keeper.key"};
    for (const char* const verb : {"make", "fail", "judge", "die", "wait"})
      program.forms.push_back(
          {.verb = verb,
           .title = verb,
           .group = "",
           .description = "",
           .more = "",
           .values = {{.name = "--output", .label = "", .kind = ValueKind::output, .words = {""}}}});
    program.forms.front().needs_key = true;
    program.check = [](const std::vector<std::string>& words) {
      if (std::ranges::find(words, "--output=odd") != words.end())
        throw std::invalid_argument("--output: odd is refused by the verb");
    };
    add_verb_routes(routes_, workspace_, jobs_, std::move(program));
    add_job_routes(routes_, jobs_);
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
  json get(const std::string& path, const std::map<std::string, std::string>& query = {}) {
    return json::parse(answer({.method = "GET", .path = path, .query = query}).body);
  }
  HttpResponse post(const std::string& path, const json& body) {
    return answer({.method = "POST",
                   .path = path,
                   .headers = {{"content-type", "application/json"}},
                   .body = body.dump()});
  }
  json ended(const std::string& verb, const json& values = json::object()) {
    const HttpResponse taken = post("/api/verbs/run", {{"verb", verb}, {"values", values}});
    if (taken.status != 200) throw std::runtime_error(taken.body);
    return test::ended_job(jobs_, json::parse(taken.body)["job"]);
  }

  TemporaryFolder folder_;
  TemporaryFolder programs_;
  Workspace workspace_{folder_.path()};
  Jobs jobs_;
  Routes routes_;
  std::uint64_t number_ = 0;
};

TEST_F(VerbRoutes, RunAVerbAndShowWhatItMade) {
  const json job = ended("make", {{"--output", "out.d"}});
  ASSERT_EQ(job["state"], "done") << job;
  EXPECT_EQ(job["title"], "kerf make --output=out.d") << "without the key's place";
  EXPECT_EQ(job["again"]["path"], "/api/verbs/run");
  const std::string number = std::to_string(job["job"].get<int>());
  EXPECT_THAT(get("/api/jobs/log", {{"job", number}})["text"].get<std::string>(),
              HasSubstr("make --output=out.d --key-file=/"));
  const json files = get("/api/jobs/result", {{"job", number}})["files"];
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0]["name"], "out.d/a.svg");
  EXPECT_EQ(files[0]["what"], "picture");
  EXPECT_EQ(files[1]["what"], "table");
  EXPECT_EQ(files[2]["what"], "other");
  const HttpResponse picture =
      answer({.method = "GET", .path = "/api/jobs/file", .query = {{"job", number}, {"file", "0"}}});
  EXPECT_EQ(picture.type, "image/svg+xml");
  EXPECT_EQ(picture.body, "<svg/>\n");
  EXPECT_TRUE(picture.is_document) << "runs and loads nothing, whatever is in it";
  EXPECT_EQ(
      answer({.method = "GET", .path = "/api/jobs/file", .query = {{"job", number}, {"file", "3"}}}).status,
      404);
}

TEST_F(VerbRoutes, SayWhatAVerbSaidAtItsEnd) {
  const json failed = ended("fail");
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["error"], "it is not there; look again");
  const json judged = ended("judge");
  EXPECT_EQ(judged["state"], "done");
  EXPECT_EQ(judged["outcome"], "did not pass");
  EXPECT_THAT(ended("die")["error"].get<std::string>(), HasSubstr("signal 9"));
}

TEST_F(VerbRoutes, StopAVerbAtWork) {
  const std::size_t job = json::parse(post("/api/verbs/run", {{"verb", "wait"}}).body)["job"];
  while (jobs_.list()[0]["share"] != 0.25) std::this_thread::yield();
  EXPECT_EQ(post("/api/jobs/stop", {{"job", job}}).status, 200);
  EXPECT_EQ(test::ended_job(jobs_, job)["state"], "stopped");
}

TEST_F(VerbRoutes, StopAVerbWhileADeviceIsBeingOpenedAndAFileRead) {
  std::atomic<int> begun{0};
  std::atomic<bool> go{false};
  Routes routes;  // ends before what its threads look at
  add_job_routes(routes, jobs_);
  const auto waits = [&](const HttpRequest&) {
    ++begun;
    while (!go) std::this_thread::yield();
    return HttpResponse{};
  };
  routes.get("/read", Routes::Pace::slow, waits);
  routes.post("/open", Routes::Pace::action, waits);
  const auto asker = std::make_shared<int>();
  EXPECT_FALSE(routes.respond({.number = 1, .method = "GET", .path = "/read", .asker = asker}, false));
  EXPECT_FALSE(routes.respond({.number = 2, .method = "POST", .path = "/open", .asker = asker}, false));
  while (begun < 2) std::this_thread::yield();
  const HttpRequest stop{.number = 3,
                         .method = "POST",
                         .path = "/api/jobs/stop",
                         .headers = {{"content-type", "application/json"}},
                         .body = R"({"job": 7})",
                         .asker = asker};
  std::optional<HttpResponse> stopped;
  for (; !stopped; stopped = routes.respond(stop, false)) std::this_thread::yield();
  go = true;
  EXPECT_EQ(stopped->status, 200) << stopped->body;
}

TEST_F(VerbRoutes, RefuseBeforeThereIsAJob) {
  const HttpResponse odd = post("/api/verbs/run", {{"verb", "make"}, {"values", {{"--output", "odd"}}}});
  EXPECT_EQ(odd.status, 400);
  EXPECT_THAT(odd.body, HasSubstr("refused by the verb"));
  EXPECT_EQ(post("/api/verbs/run", {{"verb", "rm"}}).status, 400);
  EXPECT_EQ(post("/api/verbs/run", {{"verb", "make"}, {"values", 7}}).status, 400);
  EXPECT_TRUE(jobs_.list().empty());
}

TEST_F(VerbRoutes, OfferNothingThatNeedsAKeyWhereThereIsNone) {
  EXPECT_EQ(get("/api/verbs").size(), 5U);
  Routes routes;
  add_verb_routes(routes, workspace_, jobs_,
                  {.program = "kerf",
                   .forms = {{.verb = "session new",
                              .title = "",
                              .group = "",
                              .description = "",
                              .more = "",
                              .values = {},
                              .needs_key = true}}});
  const HttpRequest request{.method = "GET", .path = "/api/verbs"};
  EXPECT_EQ(routes.respond(request, false)->body, "[]");
}

TEST_F(VerbRoutes, OfferTheFilesOfTheFolderAndNoHiddenOne) {
  std::filesystem::create_directories(folder_ / ".kerf-studio/trash");
  std::filesystem::create_directory(folder_ / "day");
  test::write_text(folder_ / "day/cut.h5", "");
  test::write_text(folder_ / ".secret", "");
  const json names = get("/api/verbs/files");
  EXPECT_EQ(names["files"], json({"day/cut.h5"}));
  EXPECT_EQ(names["folders"], json({"day"}));
}

}  // namespace
}  // namespace kerf::bench

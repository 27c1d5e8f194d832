// What somebody who should not, or something that has gone wrong, can ask of the studio.

#include <list>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/stat.h>

#include "bench/sessions/sealed/stored_session.h"
#include "server/studio.h"
#include "support/plain_client.h"
#include "support/program.h"
#include "workspace/page_uri.h"

namespace kerf::bench {
namespace {

using test::answer_to;
using test::body_of;
using test::PlainClient;
using test::status_of;
using testing::HasSubstr;
using testing::Not;

class StudioUnderAttack : public testing::Test {
 protected:
  [[nodiscard]] std::string url() const { return studio_.url(); }
  [[nodiscard]] std::uint16_t port() const {
    return static_cast<std::uint16_t>(std::stoi(url().substr(std::string("http://127.0.0.1:").size())));
  }
  [[nodiscard]] std::string token() const { return url().substr(url().find('=') + 1); }
  [[nodiscard]] std::string host() const { return fmt::format("Host: 127.0.0.1:{}\r\n", port()); }
  [[nodiscard]] std::string ours() const { return fmt::format("{}X-Kerf-Token: {}\r\n", host(), token()); }
  [[nodiscard]] std::string get(const std::string& target, const std::string& headers) const {
    return answer_to(port(), fmt::format("GET {} HTTP/1.1\r\n{}\r\n", target, headers));
  }
  [[nodiscard]] std::string post(const std::string& target, const std::string& body,
                                 const std::string& more = {}) const {
    return answer_to(port(), fmt::format("POST {} HTTP/1.1\r\n{}{}Content-Type: application/json\r\n"
                                         "Content-Length: {}\r\n\r\n{}",
                                         target, ours(), more, body.size(), body));
  }
  [[nodiscard]] std::string post_by(const std::string& target, const std::string& headers) const {
    return answer_to(port(), fmt::format("POST {} HTTP/1.1\r\n{}Content-Length: 0\r\n\r\n", target, headers));
  }

  /// The loop of a simulated device, which has to go on whatever is asked.
  void start_the_loop() const {
    ASSERT_EQ(status_of(post("/api/live/start", R"({"device": "sim:scissors"})")), "200");
  }
  [[nodiscard]] nlohmann::json status() const {
    return nlohmann::json::parse(body_of(get("/api/live/status", ours())));
  }
  /// Until the loop has made so many more ticks.
  void expect_the_loop_goes_on() const {
    const auto ticks = status().at("ticks").get<std::uint64_t>();
    nlohmann::json now = status();
    while (now.at("running").get<bool>() && now.at("ticks").get<std::uint64_t>() < ticks + 100)
      now = status();
    EXPECT_TRUE(now.at("running").get<bool>()) << now.at("ended");
    EXPECT_EQ(now.at("rows_lost"), 0);
  }

  test::TemporaryFolder folder_;
  Studio studio_{{.folder = folder_.path()}};
};

const std::vector<std::string> gets{"/",
                                    "/studio.js",
                                    "/studio.css",
                                    "/icon.svg",
                                    "/api/workspace",
                                    "/api/live/status",
                                    "/api/live/traces",
                                    "/api/live/stream?ticks=1",
                                    "/api/recording?id=0",
                                    "/api/editor/curve?id=0&axis=0",
                                    "/api/jobs",
                                    "/api/studies",
                                    "/api/study?id=0",
                                    "/api/study/report?id=0",
                                    "/api/sweep?id=0",
                                    "/api/session",
                                    "/nothing"};
const std::vector<std::string> posts{"/api/live/start",      "/api/live/resume",  "/api/live/record",
                                     "/api/live/feel",       "/api/editor/save",  "/api/fit",
                                     "/api/chart",           "/api/stability",    "/api/session/start",
                                     "/api/session/quality", "/api/session/note", "/api/sweep/answer",
                                     "/api/sweep/sample"};
const std::string zero = "/api/live/zero";

std::string with_parameter(const std::string& target, const std::string& parameter) {
  return target + (target.find('?') == std::string::npos ? "?" : "&") + parameter;
}

TEST_F(StudioUnderAttack, AnswersNobodyWithoutTheToken) {
  for (const std::string& path : gets) {
    EXPECT_EQ(status_of(get(path, host())), "403") << path;
    EXPECT_EQ(status_of(get(with_parameter(path, "token=" + std::string(32, '0')), host())), "403") << path;
    EXPECT_EQ(status_of(get(path, host() + "X-Kerf-Token: \r\n")), "403") << path;
    EXPECT_EQ(status_of(get(path, host() + "Cookie: token=" + token() + "\r\n")), "403") << path;
  }
  for (const std::string& path : posts) {
    const auto answer = answer_to(
        port(),
        fmt::format("POST {}?token={} HTTP/1.1\r\n{}Content-Type: application/json\r\nContent-Length: "
                    "2\r\n\r\n{{}}",
                    path, token(), host()));
    EXPECT_EQ(status_of(answer), "403") << path;  // by the address alone, as a form of another site could
  }
}

TEST_F(StudioUnderAttack, AnswersNoOtherSiteAndByNoOtherName) {
  for (const std::string& path : gets) {
    EXPECT_EQ(status_of(get(path, ours() + "Origin: http://evil.example\r\n")), "403") << path;
    EXPECT_EQ(status_of(get(path, ours() + "Origin: null\r\n")), "403") << path;
    const std::string by_another_name =
        fmt::format("Host: evil.example:{}\r\nX-Kerf-Token: {}\r\n", port(), token());
    EXPECT_EQ(status_of(get(path, by_another_name)), "403") << path;
  }
  for (const std::string& path : posts)
    EXPECT_EQ(status_of(post(path, "{}", "Origin: http://evil.example\r\n")), "403") << path;
}

TEST_F(StudioUnderAttack, GivesZeroForceToWhoeverAsksOnThisMachineButBackOnlyToWhoKnowsTheToken) {
  const std::string old_tab =
      fmt::format("Origin: http://127.0.0.1:{}\r\nX-Kerf-Token: {}\r\n", port(), std::string(32, '0'));
  for (const std::string& headers : {old_tab, std::string()}) {
    ASSERT_EQ(status_of(post("/api/live/resume", "{}")), "200");
    EXPECT_EQ(status_of(post_by(zero, host() + headers)), "200") << headers;
    EXPECT_EQ(status().at("released"), true) << headers;
    EXPECT_EQ(status_of(post_by("/api/live/resume", host() + headers)), "403") << headers;
    EXPECT_EQ(status().at("released"), true) << headers;
  }
}

TEST_F(StudioUnderAttack, GivesZeroForceToNoForeignPageWhichCouldSpoilATrial) {
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), std::string("https://127.0.0.1"),
        fmt::format("http://127.0.0.1:{}", port() + 1)}) {
    EXPECT_EQ(status_of(post_by(zero, host() + "Origin: " + origin + "\r\n")), "403") << origin;
    EXPECT_EQ(status_of(post(zero, "", "Origin: " + origin + "\r\n")), "403") << origin;
  }
  EXPECT_EQ(status_of(post_by(zero, fmt::format("Host: evil.example:{}\r\n", port()))), "403");
  EXPECT_EQ(status_of(get(zero, host())), "403") << "an address is opened, which nobody meant as an order";
  EXPECT_EQ(status().at("released"), false);
}

TEST_F(StudioUnderAttack, GivesEachAnswerItsPolicyWithoutInlineCode) {
  for (const std::string& path : gets) {
    if (path.find("stream") != std::string::npos) continue;  // it does not end
    const std::string answer = get(path, ours());
    EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'; style-src "
                                  "'self'; img-src 'self'; connect-src 'self'; form-action 'none'; "
                                  "frame-ancestors 'none'; base-uri 'none'\r\n"))
        << path;
    EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff\r\n")) << path;
    EXPECT_THAT(answer, Not(HasSubstr("unsafe"))) << path;
    EXPECT_THAT(answer, Not(HasSubstr("Access-Control-Allow"))) << path;
  }
  EXPECT_THAT(body_of(get("/", ours())), Not(testing::ContainsRegex("<style|<script>|style=| on[a-z]+=")));
}

/// Ways out of the folder.
const std::vector<std::string> ways_out{"..",
                                        "../../etc/passwd",
                                        "..%2f..%2fetc%2fpasswd",
                                        "/etc/passwd",
                                        "%2fetc%2fpasswd",
                                        "....//....//etc/passwd",
                                        "..\\..\\etc\\passwd",
                                        "file:///etc/passwd",
                                        "%00",
                                        "a/../../b",
                                        "~root"};

TEST_F(StudioUnderAttack, LeadsNowhereByThePath) {
  for (const std::string& way : ways_out) {
    for (const char* before : {"/", "/api/", "/subject/", "//", "/studio.js/"}) {
      const std::string answer = get(before + way, ours());
      EXPECT_THAT(status_of(answer), testing::AnyOf("404", "403", "400")) << before << way;
      EXPECT_THAT(answer, Not(HasSubstr("root:"))) << before << way;
    }
  }
}

TEST_F(StudioUnderAttack, LeadsNowhereByAnyParameterOfAnAddress) {
  start_the_loop();
  const std::vector<std::string> targets{"/api/recording?id={}",
                                         "/api/recording/view?id={}&traces=0&from=0&to=1&columns=10",
                                         "/api/recording/inspection?id={}",
                                         "/api/recording/loops?id={}&axis=0&first=1&count=1",
                                         "/api/editor/curve?id={}&axis=0",
                                         "/api/editor/law?id={}",
                                         "/api/result?id={}",
                                         "/api/law?id={}",
                                         "/api/study?id={}",
                                         "/api/study/report?id={}",
                                         "/api/study/table?id={}&name={}",
                                         "/api/study/drawn?id={}&name={}",
                                         "/api/residuals?id={}&axis=0&law={}&columns=10",
                                         "/api/live/view?traces={}&from=0&to=1&columns=10",
                                         "/api/live/view?traces=0&from={}&to=1&columns=10",
                                         "/api/live/stream?ticks={}"};
  for (const std::string& target : targets) {
    for (const std::string& way : ways_out) {
      const std::string answer = get(fmt::format(fmt::runtime(target), way, way), ours());
      EXPECT_THAT(status_of(answer), testing::AnyOf("404", "400")) << target << ' ' << way;
      EXPECT_THAT(answer, Not(HasSubstr("root:"))) << target << ' ' << way;
    }
  }
}

TEST_F(StudioUnderAttack, LeadsNowhereByAnyTextOfABody) {
  start_the_loop();
  const std::vector<std::pair<std::string, std::string>> bodies{
      {"/api/live/feel", R"({{"law": "{}"}})"},
      {"/api/live/record", R"({{"name": "{}"}})"},
      {"/api/editor/error", R"({{"recording": "{}", "axis": 0, "knots": {{}}}})"},
      {"/api/editor/best", R"({{"recording": "{}", "axis": 0, "segments": 3, "loop": false}})"},
      {"/api/editor/save",
       R"({{"name": "x", "recording": "{}", "axis": 0, "knots": {{}}, "replace": false}})"},
      {"/api/fit", R"({{"recording": "{}", "axis": "theta", "models": []}})"},
      {"/api/chart", R"({{"recording": "{}", "axis": "theta", "models": []}})"},
      {"/api/choose", R"({{"recording": "{}", "axis": "theta"}})"},
      {"/api/stability", R"({{"device": "sim:scissors", "rate_hz": 1000, "law": "{}", "cells": 10}})"},
      {"/api/session/start", R"({{"session": "{}"}})"},
      {"/api/session/quality", R"({{"session": "{}"}})"}};
  for (const auto& [path, body] : bodies) {
    for (std::string way : ways_out) {
      for (std::size_t at = way.find('\\'); at != std::string::npos; at = way.find('\\', at + 2))
        way.insert(at, 1, '\\');
      const std::string answer = post(path, fmt::format(fmt::runtime(body), way));
      EXPECT_THAT(status_of(answer), testing::AnyOf("404", "400")) << path << ' ' << way << ' ' << answer;
      EXPECT_THAT(answer, Not(HasSubstr("root:"))) << path << ' ' << way;
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(StudioUnderAttack, TakesNoDeviceThatIsAFileOrACommand) {
  for (const char* device :
       {"/etc/passwd", "file:///etc/passwd", "sim:../../etc/passwd", "sim:scissors; id", "$(id)"}) {
    const std::string answer = post("/api/live/start", fmt::format(R"({{"device": "{}"}})", device));
    EXPECT_THAT(status_of(answer), testing::AnyOf("400", "500")) << device;
    EXPECT_THAT(answer, Not(HasSubstr("root:"))) << device;
  }
  for (const char* scene : {"/etc/passwd", "../x.scene.toml", "0000000000000000"}) {
    const std::string body = fmt::format(R"({{"device": "sim:scissors", "scene_id": "{}"}})", scene);
    EXPECT_EQ(status_of(post("/api/live/start", body)), "404") << scene;
  }
}

TEST_F(StudioUnderAttack, LetsNoDriverOpenAFileOutsideOfTheFolder) {
  test::write_text(folder_ / "bad.toml", "matrix = secret\n");
  ASSERT_EQ(mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  std::filesystem::create_symlink("/etc/passwd", folder_ / "link");
  const auto answer_to_file = [&](const std::string& path, const std::string& field,
                                  const std::string& file) {
    return post(path, fmt::format(R"({{"session": "0", "{}": "{}"}})", field, file));
  };
  for (const char* const uri :
       {"u6:0?calibration=", "falcon:0?firmware=", "sim:scissors?seed=3&calibration=", "sim:axis?model="}) {
    for (const std::string& file :
         {std::string("/etc/passwd"), std::string("../../etc/passwd"), (folder_ / "bad.toml").string(),
          std::string("./bad.toml"), std::string("link"), std::string("fifo"), std::string("/dev/zero"),
          std::string(".")}) {
      for (const char* const field : {"device", "sensor"}) {
        const std::string answer = answer_to_file("/api/live/start", field, uri + file);
        EXPECT_EQ(status_of(answer), "400") << uri << file;
        EXPECT_THAT(body_of(answer), HasSubstr("from a page only a file of the studio's folder")) << file;
      }
    }
  }
  EXPECT_THAT(body_of(answer_to_file("/api/live/start", "sensor", "u6:0?calibration=bad.toml")),
              HasSubstr("bad.toml:1: "))
      << "this one may be opened";
  start_the_loop();
}

// A page of the lab's network is not to be asked by whoever has a page of the studio.
TEST_F(StudioUnderAttack, LetsNoDriverOpenAMachineOrAPort) {
  for (const char* const uri : {"net-ft:192.168.1.1", "onrobot:localhost", "net-ft:127.0.0.1?http=22",
                                "bota:/dev/tty", "ft300:fifo", "plugin:./mine.so"}) {
    for (const char* const field : {"device", "sensor"}) {
      const std::string answer =
          post("/api/live/start", fmt::format(R"({{"session": "0", "{}": "{}"}})", field, uri));
      EXPECT_EQ(status_of(answer), "400") << uri;
      EXPECT_THAT(body_of(answer), HasSubstr("no machine of the network")) << uri;
    }
  }
}

// What a name of the bench file leads to is treated as if the page had named it, and so is the sensor beside
// it.
TEST_F(StudioUnderAttack, LetsNoNameOfTheBenchLeadToAMachineAPortOrAFile) {
  const std::string file = (folder_ / "bench.toml").string();
  test::write_text(file,
                   "[device.arm]\nuri = 'woody-v4:/dev/tty'\n[device.mine]\nuri = 'plugin:mine.so'\n"
                   "[device.hand]\nuri = 'sim:pose6'\nsensor = 'wrist'\n[device.plain]\nuri = 'sim:pose6'\n"
                   "[sensor.wrist]\nuri = 'net-ft:192.168.1.1'\n[sensor.cell]\nuri = 'u6:0'\n"
                   "options = { calibration = '/etc/passwd' }\n");
  setenv("KERF_BENCH", file.c_str(), 1);
  for (const char* const name : {"arm", "mine", "hand", "wrist", "cell", "arm?calibrate=on"}) {
    for (const char* const field : {"device", "sensor"}) {
      const std::string answer = post("/api/live/start", fmt::format(R"({{"{}": "{}"}})", field, name));
      EXPECT_EQ(status_of(answer), "400") << name;
      EXPECT_THAT(body_of(answer), HasSubstr("in the bench file it leads to")) << name;
    }
  }
  // Nor by what stands for a name within a URI: the sensor of `hand` is not opened.
  EXPECT_EQ(uri_from_page(Workspace(folder_.path()), "sim:pose6?bench.toml=hand&seed=2"), "sim:pose6?seed=2");
  EXPECT_EQ(status_of(post("/api/live/start", R"({"device": "plain"})")), "200");
  unsetenv("KERF_BENCH");
}

TEST_F(StudioUnderAttack, RefusesABodyOfAGigabyteBeforeItComes) {
  start_the_loop();
  expect_the_loop_goes_on();  // its memory is locked by then, which counts as in use
  const std::string head =
      fmt::format("POST /api/live/feel HTTP/1.1\r\n{}Content-Type: application/json\r\n", ours());
  EXPECT_EQ(status_of(answer_to(port(), head + "Content-Length: 1073741824\r\n\r\n")), "413");
  // In pieces, whose sum nobody has said: the memory of this process must not grow with it.
  const auto memory = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const auto before_kb = memory();
  const PlainClient client(port());
  client.send_text(head + "Transfer-Encoding: chunked\r\n\r\n");
  const std::string piece = "100000\r\n" + std::string(1 << 20, ' ') + "\r\n";
  for (int megabyte = 0; megabyte < 1024 && client.is_open(); ++megabyte) client.send_text(piece);
  EXPECT_THAT(status_of(client.answer()), testing::AnyOf("413", ""));
  EXPECT_LT(memory() - before_kb, 50'000);
  expect_the_loop_goes_on();
}

TEST_F(StudioUnderAttack, AnswersWithAThousandSocketsOpen) {
  start_the_loop();
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  const rlimit before = files;
  files.rlim_cur = std::min<rlim_t>(files.rlim_max, 4096);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  {
    std::list<PlainClient> open;
    for (int i = 0; i < 1000; ++i) {
      open.emplace_back(port());
      open.back().send_text("GET /");
    }
    EXPECT_EQ(status_of(post("/api/live/zero", "")), "200");
    EXPECT_EQ(status_of(get("/", ours())), "200");
    expect_the_loop_goes_on();
  }
  setrlimit(RLIMIT_NOFILE, &before);
}

TEST_F(StudioUnderAttack, IsNotHeldUpByOneThatReadsNothing) {
  start_the_loop();
  std::list<PlainClient> slow;
  for (int i = 0; i < 50; ++i) {
    slow.emplace_back(port());
    slow.back().send_text(fmt::format("GET /api/live/stream?ticks=1 HTTP/1.1\r\n{}\r\n", ours()));
  }
  for (int i = 0; i < 20; ++i) EXPECT_EQ(status_of(post("/api/live/zero", "")), "200");
  expect_the_loop_goes_on();
}

/// A folder with a session that was sealed with another key than the studio's.
class StudioWithoutTheKey : public StudioUnderAttack {
 protected:
  StudioWithoutTheKey() {
    SessionStore::create(folder_ / "s.h5", kerf::test::set_up(), kerf::test::key_of('k'),
                         {.kind = "key file"}, false);
    kerf::test::write_text(folder_ / "wrong.key", std::string(32, 'x'));
  }
};

TEST_F(StudioWithoutTheKey, LetsNobodyTryOneAfterTheOther) {
  const Studio studio({.folder = folder_.path(), .key_file = folder_ / "wrong.key"});
  const std::string url = studio.url();
  const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(url.find("1:") + 2)));
  const std::string ours =
      fmt::format("Host: 127.0.0.1:{}\r\nX-Kerf-Token: {}\r\n", port, url.substr(url.find('=') + 1));
  const auto workspace = nlohmann::json::parse(
      body_of(answer_to(port, fmt::format("GET /api/workspace HTTP/1.1\r\n{}\r\n", ours))));
  const std::string body = fmt::format(R"({{"session": "{}", "device": "sim:scissors"}})",
                                       workspace.at("sessions").at(0).at("id").get<std::string>());
  const auto start = [&] {
    return answer_to(port, fmt::format("POST /api/session/start HTTP/1.1\r\n{}Content-Type: "
                                       "application/json\r\nContent-Length: {}\r\n\r\n{}",
                                       ours, body.size(), body));
  };
  for (int i = 0; i < 5; ++i) EXPECT_EQ(status_of(start()), "400") << i;
  const std::string answer = start();
  EXPECT_EQ(status_of(answer), "429");
  EXPECT_THAT(body_of(answer), HasSubstr("too many starts have failed: wait "));
}

TEST(StudioOnANetwork, TakesNoAddressThatStandsForAll) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(Studio({.folder = folder.path(), .address = "0.0.0.0"}), std::invalid_argument);
  EXPECT_THROW(Studio({.folder = folder.path(), .address = "::"}), std::invalid_argument);
  EXPECT_TRUE(Studio({.folder = folder.path()}).is_loopback());
}

}  // namespace
}  // namespace kerf::bench

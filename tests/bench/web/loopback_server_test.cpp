#include "web/loopback_server.h"

#include <atomic>
#include <list>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/plain_client.h"

namespace kerf::bench {
namespace {

using test::answer_to;
using test::PlainClient;
using test::status_of;
using testing::HasSubstr;

const std::string question = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";

LoopbackServer::Handler always(const std::string& body) {
  return [body](const HttpRequest&, bool) { return HttpResponse{.body = body}; };
}

TEST(LoopbackServer, AnswersAndHangsUp) {
  LoopbackServer server(0);
  server.start(always("hello"));
  const std::string answer = answer_to(server.port(), question);
  EXPECT_EQ(status_of(answer), "200");
  EXPECT_EQ(test::body_of(answer), "hello");
  EXPECT_THAT(answer, HasSubstr("Connection: close\r\n"));
}

TEST(LoopbackServer, LetsNothingOfOthersBeLoadedFramedOrStored) {
  LoopbackServer server(0);
  server.start(always("hello"));
  for (const std::string& request : {question, std::string("nonsense\r\n\r\n")}) {
    const std::string answer = answer_to(server.port(), request);
    EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self';"));
    EXPECT_THAT(answer, HasSubstr("frame-ancestors 'none'; base-uri 'none'\r\n"));
    EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff\r\n"));
    EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer\r\n"));
    EXPECT_THAT(answer, HasSubstr("Cache-Control: no-store\r\n"));
  }
}

TEST(LoopbackServer, TakesARequestInPieces) {
  LoopbackServer server(0);
  server.start(always("hello"));
  const PlainClient client(server.port());
  for (const char c : question) client.send_text(std::string(1, c));
  EXPECT_EQ(status_of(client.answer()), "200");
}

TEST(LoopbackServer, IsNotHeldUpByTwoHundredIdleConnections) {
  LoopbackServer server(0);
  server.start(always("hello"));
  std::list<PlainClient> idle;
  for (int i = 0; i < 200; ++i) idle.emplace_back(server.port());
  EXPECT_EQ(status_of(answer_to(server.port(), question)), "200");
  EXPECT_TRUE(idle.front().is_open()) << "the answer came only when the idle had been sent away";
}

TEST(LoopbackServer, SendsTheLongestIdleAwayWhereThereAreTooMany) {
  LoopbackServer server(0);
  server.start(always("hello"));
  std::list<PlainClient> idle;
  for (int i = 0; i < 400; ++i) idle.emplace_back(server.port());
  EXPECT_EQ(status_of(answer_to(server.port(), question)), "200");
  EXPECT_FALSE(idle.front().is_open());
  EXPECT_TRUE(idle.back().is_open());
}

TEST(LoopbackServer, DeliversALargeAnswerWhole) {
  LoopbackServer server(0);
  const std::string large(8'000'000, 'x');
  server.start(always(large));
  EXPECT_EQ(test::body_of(answer_to(server.port(), question)), large);
}

TEST(LoopbackServer, RefusesAHeadWithoutEndWithoutTakingItIn) {
  LoopbackServer server(0);
  server.start(always("hello"));
  const PlainClient client(server.port());
  client.send_text("GET / HTTP/1.1\r\n");
  for (int i = 0; i < 100; ++i)
    client.send_text("A" + std::to_string(i) + ": " + std::string(1000, 'a') + "\r\n");
  EXPECT_EQ(status_of(client.answer()), "431");
}

TEST(LoopbackServer, AsksAgainWhenWoken) {
  LoopbackServer server(0);
  std::atomic<int> asked = 0;
  std::atomic<bool> ready = false;
  server.start([&](const HttpRequest&, bool) -> std::optional<HttpResponse> {
    ++asked;
    if (!ready) return std::nullopt;
    return HttpResponse{.body = "now"};
  });
  const PlainClient client(server.port());
  client.send_text(question);
  while (asked == 0) std::this_thread::yield();
  EXPECT_TRUE(client.is_open());
  ready = true;
  server.wake();
  EXPECT_EQ(test::body_of(client.answer()), "now");
  EXPECT_EQ(asked, 2);
}

TEST(LoopbackServer, RefusesWhatNoBrowserSends) {
  LoopbackServer server(0);
  server.start(always("hello"));
  const auto status = [&](const std::string& request) {
    return status_of(answer_to(server.port(), request));
  };
  EXPECT_EQ(status("nonsense\r\n\r\n"), "400");
  EXPECT_EQ(status("GET / HTTP/3.0\r\n\r\n"), "505");
  EXPECT_EQ(status("GET a HTTP/1.1\r\nHost: a\r\n\r\n"), "400") << "no path";
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"), "400");
  EXPECT_EQ(status("GET /?a=1&a=2 HTTP/1.1\r\nHost: a\r\n\r\n"), "400");
  EXPECT_EQ(status("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5000\r\n\r\n"), "413");
  EXPECT_EQ(status("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1000000000000000000000\r\n\r\n"), "400");
}

TEST(LoopbackServer, TakesARequestApart) {
  LoopbackServer server(0);
  HttpRequest taken;
  server.start([&](const HttpRequest& request, bool) {
    taken = request;
    return HttpResponse{};
  });
  ASSERT_EQ(status_of(answer_to(server.port(),
                                "POST /view?after=12&b HTTP/1.1\r\nHost: a\r\nX-Token:  t \r\n"
                                "Content-Length: 4096\r\n\r\n" +
                                    std::string(4096, 'x'))),
            "200");
  EXPECT_EQ(taken.method, "POST");
  EXPECT_EQ(taken.path, "/view");
  EXPECT_EQ(taken.query, (std::map<std::string, std::string>{{"after", "12"}, {"b", ""}}));
  EXPECT_EQ(taken.header("x-token"), "t");
  EXPECT_EQ(taken.body.size(), 4096U) << "the longest that is taken";
}

TEST(LoopbackServer, OfATakenPortSaysSo) {
  const LoopbackServer server(0);
  try {
    const LoopbackServer second(server.port());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(server.port()) + " of 127.0.0.1"));
    EXPECT_THAT(error.what(), HasSubstr("give another one, or 0"));
  }
}

}  // namespace
}  // namespace kerf::bench

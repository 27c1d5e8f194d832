#include "http/http_server.h"

#include <atomic>
#include <list>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/plain_client.h"

namespace kerf::bench {
namespace {

using test::answer_to;
using test::PlainClient;
using test::status_of;
using testing::HasSubstr;
using testing::Not;

const std::string question = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";

HttpServer::Handler always(const std::string& body) {
  return [body](const HttpRequest&, bool) { return HttpResponse{.body = body}; };
}

TEST(HttpServer, AnswersAndHangsUp) {
  HttpServer server(0);
  server.start(always("hello"));
  const std::string answer = answer_to(server.port(), question);
  EXPECT_EQ(status_of(answer), "200");
  EXPECT_EQ(test::body_of(answer), "hello");
  EXPECT_THAT(answer, HasSubstr("Connection: close\r\n"));
}

TEST(HttpServer, LetsNothingOfOthersBeLoadedFramedOrStored) {
  HttpServer server(0);
  server.start(always("hello"));
  for (const std::string& request : {question, std::string("nonsense\r\n\r\n")}) {
    const std::string answer = answer_to(server.port(), request);
    EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self';"));
    EXPECT_THAT(answer, HasSubstr("frame-ancestors 'none'; base-uri 'none'\r\n"));
    EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff\r\n"));
    EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer\r\n"));
    EXPECT_THAT(answer, HasSubstr("Cross-Origin-Opener-Policy: same-origin\r\n"));
    EXPECT_THAT(answer, HasSubstr("Cross-Origin-Resource-Policy: same-origin\r\n"));
    EXPECT_THAT(answer, HasSubstr("Cache-Control: no-store\r\n"));
  }
}

TEST(HttpServer, LetsADocumentRunAndLoadNothing) {
  HttpServer server(0);
  server.start([](const HttpRequest&, bool) {
    return HttpResponse{.type = "text/html", .body = "<script src=/studio.js></script>", .is_document = true};
  });
  const std::string answer = answer_to(server.port(), question);
  EXPECT_THAT(
      answer,
      HasSubstr("Content-Security-Policy: default-src 'none'; style-src 'unsafe-inline'; img-src data:; "
                "form-action 'none'; frame-ancestors 'none'; base-uri 'none'\r\n"));
  EXPECT_THAT(answer, Not(HasSubstr("script-src")));
  EXPECT_THAT(answer, HasSubstr("Cross-Origin-Opener-Policy: same-origin\r\n"));
}

TEST(HttpServer, TakesARequestInPieces) {
  HttpServer server(0);
  server.start(always("hello"));
  const PlainClient client(server.port());
  for (const char c : question) client.send_text(std::string(1, c));
  EXPECT_EQ(status_of(client.answer()), "200");
}

TEST(HttpServer, IsNotHeldUpByTwoHundredIdleConnections) {
  HttpServer server(0);
  server.start(always("hello"));
  std::list<PlainClient> idle;
  for (int i = 0; i < 200; ++i) idle.emplace_back(server.port());
  EXPECT_EQ(status_of(answer_to(server.port(), question)), "200");
  EXPECT_TRUE(idle.front().is_open()) << "the answer came only when the idle had been sent away";
}

TEST(HttpServer, SendsTheLongestIdleAwayWhereThereAreTooMany) {
  HttpServer server(0);
  server.start(always("hello"));
  std::list<PlainClient> idle;
  for (int i = 0; i < 400; ++i) idle.emplace_back(server.port());
  EXPECT_EQ(status_of(answer_to(server.port(), question)), "200");
  EXPECT_FALSE(idle.front().is_open());
  EXPECT_TRUE(idle.back().is_open());
}

TEST(HttpServer, DeliversALargeAnswerWhole) {
  HttpServer server(0);
  const std::string large(8'000'000, 'x');
  server.start(always(large));
  EXPECT_EQ(test::body_of(answer_to(server.port(), question)), large);
}

TEST(HttpServer, RefusesAHeadWithoutEndWithoutTakingItIn) {
  HttpServer server(0);
  server.start(always("hello"));
  const PlainClient client(server.port());
  client.send_text("GET / HTTP/1.1\r\n");
  for (int i = 0; i < 100; ++i)
    client.send_text("A" + std::to_string(i) + ": " + std::string(1000, 'a') + "\r\n");
  EXPECT_EQ(status_of(client.answer()), "431");
}

TEST(HttpServer, AsksAgainWhenWoken) {
  HttpServer server(0);
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

TEST(HttpServer, RefusesWhatNoBrowserSends) {
  HttpServer server(0);
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

TEST(HttpServer, TakesARequestApart) {
  HttpServer server(0);
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

TEST(HttpServer, OfATakenPortSaysSo) {
  const HttpServer server(0);
  try {
    const HttpServer second(server.port());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(server.port()) + " of 127.0.0.1"));
    EXPECT_THAT(error.what(), HasSubstr("give another one, or 0"));
  }
}

TEST(HttpServer, StreamsWhatComesAfterTheBodyUntilTheBrowserLeaves) {
  std::atomic<int> asked = 0;
  HttpServer server(0);
  server.start([&](const HttpRequest&, bool) {
    return HttpResponse{.body = "first;", .more = [&] { return std::string(++asked <= 3 ? "more;" : ""); }};
  });
  const PlainClient client(server.port());
  client.send_text(question);
  std::string text;
  {
    const std::jthread waking([&server](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        server.wake();
        std::this_thread::yield();
      }
    });
    while (text.find("more;more;more;") == std::string::npos) text += client.some();
  }
  EXPECT_EQ(test::body_of(text), "first;more;more;more;");
  EXPECT_THAT(text, Not(HasSubstr("Content-Length")));
  EXPECT_TRUE(client.is_open());
  server.stop();
  EXPECT_EQ(client.answer(), "");
}

TEST(HttpServer, AsksNothingMoreForABrowserThatTakesNothing) {
  std::atomic<int> asked = 0;
  HttpServer server(0);
  server.start([&](const HttpRequest&, bool) {
    return HttpResponse{.more = [&] {
      ++asked;
      return std::string(1 << 20, 'x');
    }};
  });
  const PlainClient client(server.port());
  client.send_text(question);
  EXPECT_EQ(status_of(client.some()), "200");
  // What the system's buffers hold, some MB at most, then nothing more.
  for (int i = 0; i < 2000; ++i) server.wake();
  EXPECT_EQ(status_of(answer_to(server.port(), "nonsense\r\n\r\n")), "400");
  EXPECT_LT(asked, 50);
}

TEST(HttpServer, GoesOnWhereAHandlerThrows) {
  HttpServer server(0);
  std::atomic<int> asked = 0;
  server.start([&](const HttpRequest&, bool) -> HttpResponse {
    if (++asked == 1) throw std::runtime_error("no memory");
    return {.body = "hello"};
  });
  EXPECT_EQ(status_of(answer_to(server.port(), question)), "500");
  EXPECT_EQ(test::body_of(answer_to(server.port(), question)), "hello");
}

TEST(HttpServer, TakesBodiesUpToItsLimit) {
  HttpServer server({.max_body = 10});
  server.start([](const HttpRequest& request, bool) { return HttpResponse{.body = request.body}; });
  const auto post = [&](const std::string& body) {
    return answer_to(server.port(), "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: " +
                                        std::to_string(body.size()) + "\r\n\r\n" + body);
  };
  EXPECT_EQ(test::body_of(post("0123456789")), "0123456789");
  EXPECT_EQ(status_of(post("0123456789a")), "413");
}

TEST(HttpServer, KnowsWhenNobodyWaitsForAnAnswer) {
  std::mutex mutex;
  std::vector<HttpRequest> asked;
  HttpServer server(0);
  server.start([&](const HttpRequest& request, bool) -> std::optional<HttpResponse> {
    const std::lock_guard lock(mutex);
    asked.push_back(request);
    return std::nullopt;
  });
  const auto number_asked = [&] {
    const std::lock_guard lock(mutex);
    return asked.size();
  };
  {
    const PlainClient client(server.port());
    client.send_text(question);
    while (number_asked() == 0) std::this_thread::yield();
    EXPECT_FALSE(asked.front().asker.expired());
  }
  while (!asked.front().asker.expired()) std::this_thread::yield();
  EXPECT_EQ(asked.front().number, 1U);
}

}  // namespace
}  // namespace kerf::bench

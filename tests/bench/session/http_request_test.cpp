#include "session/http_request.h"

#include <string>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

int refusal_of(const std::string& text) { return read_http_request(text).refusal; }

TEST(HttpRequest, IsTakenApart) {
  const HttpReading reading = read_http_request(
      "POST /action?after=12&x HTTP/1.1\r\nHost: localhost:80\r\nContent-LENGTH:  2 \r\n\r\n{}");
  ASSERT_TRUE(reading.request);
  EXPECT_EQ(reading.request->method, "POST");
  EXPECT_EQ(reading.request->path, "/action");
  EXPECT_EQ(reading.request->query.at("after"), "12");
  EXPECT_EQ(reading.request->query.at("x"), "");
  EXPECT_EQ(reading.request->header("host"), "localhost:80");
  EXPECT_EQ(reading.request->header("origin"), "");
  EXPECT_EQ(reading.request->body, "{}");
}

TEST(HttpRequest, IsWaitedForToItsLastByte) {
  const std::string whole = "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhello";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const HttpReading reading = read_http_request(std::string_view(whole).substr(0, size));
    EXPECT_FALSE(reading.request) << size;
    EXPECT_EQ(reading.refusal, 0) << size;
  }
  EXPECT_TRUE(read_http_request(whole).request);
}

TEST(HttpRequest, ThatIsMalformedIsRefused) {
  for (const char* text : {
           "GET\r\n\r\n",
           "GET view HTTP/1.1\r\n\r\n",
           "GET  / HTTP/1.1\r\n\r\n",
           "GET /\x01 HTTP/1.1\r\n\r\n",
           "GET /?a=1&a=2 HTTP/1.1\r\n\r\n",
           "GET / HTTP/1.1\r\nHost\r\n\r\n",
           "GET / HTTP/1.1\r\nHost : a\r\n\r\n",
           "GET / HTTP/1.1\r\nHost: a\r\nHOST: b\r\n\r\n",
           "GET / HTTP/1.1\r\nHost: a\r\n b\r\n\r\n",
           "GET / HTTP/1.1\nHost: a\r\n\r\n",
           "GET / HTTP/1.1\r\nHost: a\x7f\r\n\r\n",
           "POST / HTTP/1.1\r\nContent-Length: 1x\r\n\r\n",
           "POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
           "POST / HTTP/1.1\r\nContent-Length: 1\r\n\r\nab",
       }) {
    EXPECT_EQ(refusal_of(text), 400) << text;
  }
}

TEST(HttpRequest, ThatIsNotForAServerSoSmallIsRefusedByItsOwnStatus) {
  EXPECT_EQ(refusal_of("GET / HTTP/2.0\r\n\r\n"), 505);
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\n\r\n"), 411);
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), 501);
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\nContent-Length: 4097\r\n\r\n"), 413);
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999999\r\n\r\n"), 413);
  EXPECT_EQ(refusal_of("GET /" + std::string(most_http_head, 'a')), 431);
  EXPECT_EQ(refusal_of("GET / HTTP/1.1\r\nA: " + std::string(most_http_head, 'a') + "\r\n\r\n"), 431);
}

TEST(HttpRequest, OfTheLongestBodyIsTaken) {
  const HttpReading reading =
      read_http_request("POST / HTTP/1.1\r\nContent-Length: 4096\r\n\r\n" + std::string(4096, 'a'));
  ASSERT_TRUE(reading.request);
  EXPECT_EQ(reading.request->body.size(), 4096U);
}

}  // namespace
}  // namespace kerf::bench

#include "pages/access_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

class AccessControlOfAServer : public testing::Test {
 protected:
  [[nodiscard]] HttpRequest asking(const std::string& method = "GET") const {
    return {.method = method, .headers = {{"host", "127.0.0.1:80"}, {"x-kerf-token", access_.token()}}};
  }

  AccessControl access_{std::vector<std::string>{"127.0.0.1:80", "localhost:80"}};
};

TEST_F(AccessControlOfAServer, HasAnotherTokenOf128BitsEachTime) {
  EXPECT_EQ(access_.token().size(), 32U);
  EXPECT_NE(access_.token(), AccessControl({"a"}).token());
  EXPECT_EQ(access_.url("/x/"), "http://127.0.0.1:80/x/?token=" + access_.token());
}

TEST_F(AccessControlOfAServer, AdmitsWhoeverKnowsTheToken) {
  EXPECT_TRUE(access_.admits(asking()));
  EXPECT_TRUE(access_.admits(asking("POST")));
  HttpRequest by_name = asking();
  by_name.headers["host"] = "localhost:80";
  by_name.headers["origin"] = "http://localhost:80";
  EXPECT_TRUE(access_.admits(by_name));
}

TEST_F(AccessControlOfAServer, RefusesAWrongOrMissingToken) {
  HttpRequest request = asking();
  request.headers["x-kerf-token"].back() ^= 1;
  EXPECT_FALSE(access_.admits(request));
  request.headers["x-kerf-token"] = "";
  EXPECT_FALSE(access_.admits(request));
  request.headers.erase("x-kerf-token");
  EXPECT_FALSE(access_.admits(request));
}

TEST_F(AccessControlOfAServer, AnswersGuessesMoreBrieflyAndStillAdmitsWhoKnows) {
  for (int guess = 0; guess < 100; ++guess) {
    const HttpResponse answer = access_.refuse("No.");
    ASSERT_EQ(answer.status, 403) << guess;
    ASSERT_EQ(answer.body, "No.\n");
  }
  EXPECT_EQ(access_.refuse("No.").status, 429);
  EXPECT_TRUE(access_.admits(asking()));
}

TEST_F(AccessControlOfAServer, SaysWhyAgainAfterTenSecondsHoweverOftenItIsAskedMeanwhile) {
  // A tab from before the studio was started anew asks on and on; what it is told is why it should be
  // reloaded.
  const auto begin = AttemptLimit::Clock::now();
  int told = 0;
  for (int tenth = 0; tenth < 1000; ++tenth)
    for (int tab = 0; tab < 2; ++tab)
      told += access_.refuse("No.", begin + std::chrono::milliseconds(100 * tenth)).status == 403 ? 1 : 0;
  EXPECT_EQ(told, 1000) << "100 in each 10 s";
}

TEST_F(AccessControlOfAServer, HasAKeyForOneAddressThatOpensNoOther) {
  HttpRequest request = asking();
  request.headers.erase("x-kerf-token");
  request.path = "/api/study/report";
  request.query = {{"id", "1f"}};
  const std::string key = access_.key_for(request.path, request.query);
  EXPECT_EQ(key.find(access_.token()), std::string::npos);
  request.query["key"] = key;
  EXPECT_TRUE(access_.admits(request));
  for (const auto& [path, id] : {std::pair("/api/study/report", "2f"), std::pair("/api/study/table", "1f")}) {
    HttpRequest other = request;
    other.path = path;
    other.query["id"] = id;
    EXPECT_FALSE(access_.admits(other)) << path << ' ' << id;
  }
  HttpRequest longer = request;
  longer.query["name"] = "x";
  EXPECT_FALSE(access_.admits(longer)) << "a further parameter";
  request.method = "POST";
  EXPECT_FALSE(access_.admits(request)) << "it is no way to act";
  request.method = "GET";
  EXPECT_NE(key, AccessControl({"127.0.0.1:80"}).key_for(request.path, request.query)) << "of another studio";
}

TEST_F(AccessControlOfAServer, RefusesActionsByAnAddressAlone) {
  HttpRequest request = asking();
  request.headers.erase("x-kerf-token");
  request.query["token"] = access_.token();
  EXPECT_TRUE(access_.admits(request));
  request.method = "POST";
  EXPECT_FALSE(access_.admits(request));
}

TEST_F(AccessControlOfAServer, AsksForNoTokenWhereNoneIsNeeded) {
  HttpRequest request = asking("POST");
  request.headers["x-kerf-token"] = "an old one";
  EXPECT_TRUE(access_.admits_without_token(request));
  request.headers.erase("x-kerf-token");
  EXPECT_TRUE(access_.admits_without_token(request));
  request.headers["origin"] = "http://127.0.0.1:80";
  EXPECT_TRUE(access_.admits_without_token(request));
  EXPECT_FALSE(access_.admits(request));
}

TEST_F(AccessControlOfAServer, RefusesOtherSitesAndOtherNamesOfTheMachine) {
  for (const char* origin : {"http://evil.example", "https://127.0.0.1:80", "null", "http://127.0.0.1:81",
                             "http://127.0.0.1:80.evil.example"}) {
    HttpRequest request = asking();
    request.headers["origin"] = origin;
    EXPECT_FALSE(access_.admits(request)) << origin;
    EXPECT_FALSE(access_.admits_without_token(request)) << origin;
  }
  for (const char* host : {"evil.example", "127.0.0.1", "127.0.0.1:81", ""}) {
    HttpRequest request = asking();
    request.headers["host"] = host;
    EXPECT_FALSE(access_.admits(request)) << host;
    EXPECT_FALSE(access_.admits_without_token(request)) << host;
  }
}

}  // namespace
}  // namespace kerf::bench

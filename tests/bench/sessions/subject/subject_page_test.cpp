#include "subject/subject_page.h"

#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/plain_client.h"
#include "views.h"

namespace kerf::bench {
namespace {

using test::body_of;
using test::in_words;
using test::status_of;
using testing::HasSubstr;

class SubjectPage : public testing::Test {
 protected:
  [[nodiscard]] std::uint16_t port() const {
    return static_cast<std::uint16_t>(std::stoi(page_.url().substr(std::string("http://127.0.0.1:").size())));
  }
  [[nodiscard]] std::string host() const { return fmt::format("127.0.0.1:{}", port()); }
  [[nodiscard]] std::string token() const { return page_.url().substr(page_.url().find('=') + 1); }

  [[nodiscard]] std::string get(const std::string& target, const std::string& headers) const {
    return test::answer_to(port(), fmt::format("GET {} HTTP/1.1\r\n{}\r\n", target, headers));
  }
  [[nodiscard]] std::string ours() const {
    return fmt::format("Host: {}\r\nX-Kerf-Token: {}\r\n", host(), token());
  }
  [[nodiscard]] std::string post(const std::string& body) const {
    return test::answer_to(port(),
                           fmt::format("POST /action HTTP/1.1\r\n{}Origin: http://{}\r\nContent-Type: "
                                       "application/json\r\nContent-Length: {}\r\n\r\n{}",
                                       ours(), host(), body.size(), body));
  }
  [[nodiscard]] std::string act(const std::string& kind, std::size_t slot, const std::string& stage,
                                std::size_t trial) const {
    return status_of(
        post(nlohmann::json{{"kind", kind}, {"slot", slot}, {"stage", stage}, {"trial", trial}}.dump()));
  }

  ServedSubject page_;
};

TEST_F(SubjectPage, IsOpenedByItsAddressAlone) {
  const std::string answer = get("/?token=" + token(), "Host: " + host() + "\r\n");
  EXPECT_EQ(status_of(answer), "200");
  EXPECT_THAT(answer, HasSubstr("Content-Type: text/html"));
  EXPECT_THAT(answer, HasSubstr("page.js?token=" + token()));
  EXPECT_EQ(body_of(answer).find("{{"), std::string::npos);
}

TEST_F(SubjectPage, HasAnotherTokenOf128BitsEachTime) {
  const ServedSubject other;
  EXPECT_EQ(token().size(), 32U);
  EXPECT_EQ(token().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token(), other.url().substr(other.url().find('=') + 1));
}

TEST_F(SubjectPage, RefusesWhoeverDoesNotKnowTheToken) {
  const std::string from_here = "Host: " + host() + "\r\n";
  std::string nearly = token();
  nearly.back() = nearly.back() == '0' ? '1' : '0';
  for (const std::string& target :
       {std::string("/"), std::string("/view?after=0"), std::string("/page.js"), std::string("/nowhere"),
        "/?token=" + nearly, "/?token=" + token() + "0", std::string("/?token=")}) {
    EXPECT_EQ(status_of(get(target, from_here)), "403") << target;
  }
  EXPECT_EQ(status_of(get("/?token=" + token(), from_here + "X-Kerf-Token: " + nearly + "\r\n")), "403");
}

TEST_F(SubjectPage, RefusesOtherNamesForThisMachineAndOtherSites) {
  const std::string target = "/?token=" + token();
  EXPECT_EQ(status_of(get(target, fmt::format("Host: localhost:{}\r\n", port()))), "200");
  EXPECT_EQ(status_of(get(target, "")), "403");
  EXPECT_EQ(status_of(get(target, "Host: 127.0.0.1\r\n")), "403");
  EXPECT_EQ(status_of(get(target, fmt::format("Host: rebound.example:{}\r\n", port()))), "403");
  EXPECT_EQ(status_of(get(target, ours() + "Origin: http://evil.example\r\n")), "403");
  EXPECT_EQ(status_of(get(target, ours() + "Origin: null\r\n")), "403");
  EXPECT_EQ(status_of(get(target, ours() + fmt::format("Origin: https://{}\r\n", host()))), "403");
  EXPECT_EQ(status_of(get(target, ours() + fmt::format("Origin: http://localhost:{}\r\n", port()))), "200");
}

TEST_F(SubjectPage, ServesItsOwnFilesAndNoOthers) {
  for (const char* path : {"/page.css", "/page.js", "/noise.js", "/guide.js", "/icon.svg"})
    EXPECT_EQ(status_of(get(path, ours())), "200");
  for (const char* path :
       {"/page.html", "/../page.js", "//etc/passwd", "/%2e%2e/etc/passwd", "/page.js/", "/action/"}) {
    EXPECT_EQ(status_of(get(path, ours())), "404") << path;
  }
  EXPECT_EQ(status_of(get("/action", ours())), "405");
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "HEAD"}) {
    EXPECT_EQ(status_of(test::answer_to(port(), fmt::format("{} /view HTTP/1.1\r\n{}\r\n", method, ours()))),
              "405");
  }
}

TEST_F(SubjectPage, TakesActionsOnlyWithTheHeaderThatNoOtherSiteCanSend) {
  page_.show(test::free_trial(5));
  const std::string body = R"({"kind": "answer", "slot": 0, "stage": "trial", "trial": 5})";
  const auto post_with = [&](const std::string& target, const std::string& headers) {
    return status_of(test::answer_to(port(), fmt::format("POST {} HTTP/1.1\r\n{}Content-Length: {}\r\n\r\n{}",
                                                         target, headers, body.size(), body)));
  };
  EXPECT_EQ(
      post_with("/action?token=" + token(), "Host: " + host() + "\r\nContent-Type: application/json\r\n"),
      "403");
  EXPECT_EQ(post_with("/action", ours() + "Content-Type: text/plain\r\n"), "415");
  EXPECT_EQ(in_words(page_.next()), "nothing");
  EXPECT_EQ(post_with("/action", ours() + "Content-Type: application/json\r\n"), "200");
  EXPECT_EQ(in_words(page_.next()), "answer 0");
}

TEST_F(SubjectPage, GivesTheViewWithoutWhatIsNotInIt) {
  page_.show(test::free_trial(5));
  const auto view = nlohmann::json::parse(body_of(get("/view?after=0", ours())));
  EXPECT_EQ(view["heading"], "Which is softer?");
  EXPECT_EQ(view["progress"], "Trial 5 of 24");
  EXPECT_EQ(view["plays"], "You feel A now.");
  EXPECT_EQ(view["labels"], (std::vector<std::string>{"A", "B", "X"}));
  EXPECT_EQ(view["answers"], 2);
  EXPECT_EQ(view["playing"], 0);
  EXPECT_EQ(view["number"], 1);
  EXPECT_EQ(status_of(get("/view?after=x", ours())), "400");
}

TEST_F(SubjectPage, TellsAWaitingPageOfTheNextView) {
  page_.show(test::free_trial(5));
  const test::PlainClient first(port());
  const test::PlainClient second(port());
  for (const auto* client : {&first, &second})
    client->send_text(fmt::format("GET /view?after=1 HTTP/1.1\r\n{}\r\n", ours()));
  page_.show(test::free_trial(6));
  for (const auto* client : {&first, &second}) {
    EXPECT_EQ(nlohmann::json::parse(body_of(client->answer()))["trial"], 6);
  }
}

TEST_F(SubjectPage, ShowsItsLastViewBeforeItEnds) {
  auto page = std::make_unique<ServedSubject>();
  const std::string url = page->url();
  const auto its_port = static_cast<std::uint16_t>(std::stoi(url.substr(17)));
  const std::string headers =
      fmt::format("Host: localhost:{}\r\nX-Kerf-Token: {}\r\n", its_port, url.substr(url.find('=') + 1));
  page->show(test::free_trial(24));
  EXPECT_EQ(status_of(test::answer_to(its_port, "GET /view?after=0 HTTP/1.1\r\n" + headers + "\r\n")), "200");
  const test::PlainClient client(its_port);
  client.send_text("GET /view?after=1 HTTP/1.1\r\n" + headers + "\r\n");
  page->show({.stage = SessionStage::finished});
  page.reset();
  EXPECT_THAT(client.answer(), HasSubstr("\"stage\":\"finished\""));
}

TEST_F(SubjectPage, RefusesWhatWasMeantForAnotherScreen) {
  page_.show(test::free_trial(5));
  EXPECT_EQ(act("answer", 0, "trial", 4), "409");
  EXPECT_EQ(act("answer", 0, "instructions", 5), "409");
  EXPECT_EQ(in_words(page_.next()), "nothing");
  EXPECT_EQ(act("answer", 1, "trial", 5), "200");
  page_.show(test::free_trial(6));
  EXPECT_EQ(in_words(page_.next()), "nothing") << "an answer to the trial before";
}

TEST_F(SubjectPage, RefusesWhatTheViewDoesNotPermit) {
  SubjectView view = test::sequence_trial(5);
  view.may_answer = false;
  page_.show(view);
  EXPECT_EQ(act("answer", 0, "trial", 5), "409");
  EXPECT_EQ(act("play", 0, "trial", 5), "409");
  EXPECT_EQ(act("go_on", 0, "trial", 5), "409");
  EXPECT_EQ(act("decline", 0, "trial", 5), "409");
  EXPECT_EQ(act("quit", 0, "trial", 5), "200");
  page_.show(test::free_trial(5));
  EXPECT_EQ(act("answer", 2, "trial", 5), "409") << "X is no answer";
  EXPECT_EQ(act("play", 3, "trial", 5), "409");
}

TEST_F(SubjectPage, TakesATrialBackOnlyWhereItMayBe) {
  SubjectView view = test::free_trial(5);
  page_.show(view);
  EXPECT_EQ(act("slip", 0, "trial", 5), "409");
  view.may_slip = true;
  page_.show(view);
  EXPECT_EQ(act("slip", 0, "trial", 5), "200");
  EXPECT_EQ(in_words(page_.next()), "slip");
}

TEST_F(SubjectPage, RefusesWhatIsNoAction) {
  page_.show(test::free_trial(5));
  const std::string nested(4000, '[');
  for (const std::string& body :
       {std::string("{"), std::string("[]"), std::string("{}"), std::string("null"), nested,
        std::string(R"({"kind": "steal", "slot": 0, "stage": "trial", "trial": 5})"),
        std::string(R"({"kind": "play", "slot": -1, "stage": "trial", "trial": 5})"),
        std::string(R"({"kind": "play", "slot": 0.5, "stage": "trial", "trial": 5})"),
        std::string(R"({"kind": 2, "slot": 0, "stage": "trial", "trial": 5})")}) {
    EXPECT_EQ(status_of(post(body)), "400") << body.substr(0, 60);
  }
  EXPECT_EQ(status_of(post(std::string(4097, ' '))), "413");
  EXPECT_EQ(in_words(page_.next()), "nothing");
}

TEST_F(SubjectPage, KeepsOnlySoManyActions) {
  page_.show(test::free_trial(5));
  for (int i = 0; i < 16; ++i) EXPECT_EQ(act("play", 0, "trial", 5), "200");
  EXPECT_EQ(act("play", 0, "trial", 5), "503");
}

TEST_F(SubjectPage, AsksForTheLoudnessOfTheNoiseFirstAndKeepsItOnTheSessionsThread) {
  std::vector<double> kept;
  page_.page().use_noise(MaskingNoise::pink, std::nullopt,
                         [&](double level_db) { kept.push_back(level_db); });
  page_.show({.stage = SessionStage::welcome, .may_go_on = true});
  const auto noise = [&] { return nlohmann::json::parse(body_of(get("/view?after=0", ours()))).at("noise"); };
  EXPECT_EQ(noise().at("kind"), "pink");
  EXPECT_TRUE(noise().at("level_db").is_null());
  EXPECT_EQ(act("go_on", 0, "welcome", 0), "409");
  const auto set = [&](const std::string& body) {
    return status_of(test::answer_to(
        port(), fmt::format("POST /noise HTTP/1.1\r\n{}Content-Type: application/json\r\nContent-Length: "
                            "{}\r\n\r\n{}",
                            ours(), body.size(), body)));
  };
  for (const char* const body :
       {"{}", "[]", R"({"level_db": 0})", R"({"level_db": -80})", R"({"level_db": "x"})"})
    EXPECT_EQ(set(body), "400") << body;
  EXPECT_EQ(set(R"({"level_db": -30})"), "200");
  EXPECT_TRUE(kept.empty());
  EXPECT_FALSE(page_.next());
  EXPECT_THAT(kept, testing::ElementsAre(-30.0));
  EXPECT_EQ(noise().at("level_db"), -30.0);
  EXPECT_EQ(set(R"({"level_db": -20})"), "409") << "it is set once";
  EXPECT_EQ(act("go_on", 0, "welcome", 0), "200");
}

TEST_F(SubjectPage, ShowsTargetAndToolAsSharesOfTheWayWhileTheLoopRuns) {
  EXPECT_EQ(status_of(get("/guide", ours())), "404") << "nothing leads";
  GuideLook look;
  page_.page().use_guide({.kind = GuideKind::strokes,
                          .from = 0.5,
                          .to = 0.1,
                          .stroke_s = 1.0,
                          .pause_s = 0.5,
                          .felt = FeltGuide{.stiffness = 5.0, .limit = 1.0}},
                         [&] { return look; });
  page_.show({.stage = SessionStage::trial, .guided = true});
  const nlohmann::json view = nlohmann::json::parse(body_of(get("/view?after=0", ours())));
  EXPECT_EQ(view.at("guide"),
            (nlohmann::json{
                {"target", true}, {"tool", true}, {"cycle_s", 3.0}, {"clicks", false}, {"leads", true}}));
  EXPECT_EQ(status_of(get("/guide", ours())), "409") << "the loop does not run yet";
  look = {.time_s = 1.0, .position = 0.4};
  const nlohmann::json now = nlohmann::json::parse(body_of(get("/guide", ours())));
  EXPECT_EQ(now.at("time_s"), 1.0);
  EXPECT_NEAR(now.at("target").get<double>(), 0.5, 1e-12) << "half way along the first stroke";
  EXPECT_NEAR(now.at("tool").get<double>(), 0.25, 1e-12);
  EXPECT_EQ(now.size(), 3U) << "and no force";
  EXPECT_EQ(status_of(get("/guide", "Host: " + host() + "\r\n")), "403");
  EXPECT_EQ(status_of(test::answer_to(port(), "POST /guide HTTP/1.1\r\n" + ours() + "\r\n")), "405");
}

TEST_F(SubjectPage, TellsOfABeatItsTimeAlone) {
  page_.page().use_guide({.kind = GuideKind::metronome, .beat_s = 0.75},
                         [] { return GuideLook{.time_s = 2.0, .position = 0.4}; });
  page_.show({.stage = SessionStage::trial, .guided = true});
  EXPECT_EQ(nlohmann::json::parse(body_of(get("/guide", ours()))), (nlohmann::json{{"time_s", 2.0}}));
  const nlohmann::json view = nlohmann::json::parse(body_of(get("/view?after=0", ours())));
  EXPECT_EQ(view.at("guide").at("clicks"), true);
  EXPECT_EQ(view.at("guide").at("cycle_s"), 0.75);
}

TEST_F(SubjectPage, SpeaksOfNoNoiseWhereNoneIsAskedFor) {
  page_.show({.stage = SessionStage::welcome, .may_go_on = true});
  EXPECT_TRUE(nlohmann::json::parse(body_of(get("/view?after=0", ours()))).at("noise").is_null());
  EXPECT_EQ(act("go_on", 0, "welcome", 0), "200");
}

}  // namespace
}  // namespace kerf::bench

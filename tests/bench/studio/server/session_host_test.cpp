// A session of an experiment, run from the studio.

#include "server/session_host.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "http/routes.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using kerf::test::run_kerf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(SessionHost, RefusesTheSessionOfAParticipantWhoWasDropped) {
  const kerf::test::TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return (folder / name).string(); };
  for (const char* law : {"soft.law.toml", "stiff.law.toml"})
    kerf::test::write_text(folder / law, kerf::test::law_called(law));
  kerf::test::write_text(
      folder / "p.protocol.toml",
      kerf::test::protocol_text("design = \"abx\"\ntrials = 2\ndevice = \"sim:scissors\"\n"));
  const auto expect_done = [](const std::vector<std::string>& words) {
    const kerf::test::Outcome outcome = run_kerf(words);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  };
  expect_done({"session", "key", path("k.key")});
  expect_done({"session", "plan", path("p.protocol.toml"), "--participants", "2", "-o", path("study")});
  expect_done({"session", "new", path("study"), "--no-check", "--key-file", path("k.key")});
  expect_done({"session", "drop", path("study"), "S01", "--reason", "left", "--key-file", path("k.key")});
  SessionHost host(
      {}, [] {}, [](const std::string&) {});
  SessionHost::Order order;
  order.file = path("study/S01.h5");
  order.key_file = path("k.key");
  EXPECT_THAT([&] { host.start(order, [] {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("S01 was dropped (left)")));
}

/// A rehearsed session of two samples, whose names stand in nothing that is told of it.
class LookedAtSession : public testing::Test {
 protected:
  LookedAtSession() {
    for (const char* law : {"soft.law.toml", "stiff.law.toml"})
      kerf::test::write_text(folder_ / law, kerf::test::law_called(law));
    kerf::test::write_text(
        path("p.protocol.toml"),
        kerf::test::protocol_text("design = \"abx\"\ntrials = 3\ndevice = \"sim:scissors\"\n"));
    kerf({"session", "key", path("k.key")});
    kerf({"session", "key", path("other.key")});
    kerf({"session", "new", path("p.protocol.toml"), "--subject", "S01", "--no-check", "--key-file",
          path("k.key"), "-o", path("S01.h5")});
    order_.file = path("S01.h5");
    order_.key_file = path("k.key");
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static kerf::test::Outcome kerf(const std::vector<std::string>& words, int status = 0) {
    kerf::test::Outcome outcome = run_kerf(words);
    EXPECT_EQ(outcome.exit_status, status) << outcome.errors;
    return outcome;
  }
  void rehearse() const {
    kerf({"session", "run", path("S01.h5"), "--rehearse", "--no-check", "--key-file", path("k.key")});
  }

  kerf::test::TemporaryFolder folder_;
  SessionHost host_{{}, [] {}, [](const std::string&) {}};
  SessionHost::Order order_;
};

TEST_F(LookedAtSession, TellsHowItsTrialsWentAndNothingOfTheSamples) {
  EXPECT_EQ(host_.look(order_)["quality"]["given"], 0);
  rehearse();
  const nlohmann::ordered_json look = host_.look(order_);
  EXPECT_EQ(look["subject"], "S01");
  EXPECT_EQ(look["finished"], true);
  EXPECT_EQ(look["planned"], 3);
  EXPECT_EQ(look["quality"]["given"], 3);
  EXPECT_GE(look["quality"]["contact_share"].get<double>(), 0.0);
  EXPECT_LE(look["quality"]["contact_share"].get<double>(), 1.0);
  EXPECT_GT(look["quality"]["median_response_s"].get<double>(), 0.0);
  const std::string text = look.dump();
  for (const char* told :
       {"\"soft\"", "stiff", "slot", "level", "answer", "law", "\"A\"", "\"X\"", "correct"})
    EXPECT_THAT(text, testing::Not(HasSubstr(told)));
  const auto facts = nlohmann::json::parse(kerf({"info", path("S01.h5"), "--json"}).output);
  EXPECT_TRUE(facts["openings"].empty()) << "nothing was unblinded, so nothing is noted";
}

TEST_F(LookedAtSession, IsNotOpenedByAnotherKeyNorByOneAfterTheOther) {
  SessionHost::Order other = order_;
  other.key_file = path("other.key");
  for (int tries = 0; tries < 5; ++tries) EXPECT_THROW((void)host_.look(other), std::invalid_argument);
  EXPECT_THAT([&] { (void)host_.look(order_); },
              ThrowsMessage<RequestError>(HasSubstr("too many starts have failed")));
}

TEST_F(LookedAtSession, TakesANoteByTheProgramAtAnyTime) {
  const auto note = [&](const std::string& text, int status = 0) {
    return kerf({"session", "note", path("S01.h5"), text, "--key-file", path("k.key")}, status);
  };
  EXPECT_THAT(note(" came late ").output, HasSubstr("Receipt "));
  rehearse();
  note("the hand support had slipped");
  const nlohmann::ordered_json notes = host_.look(order_)["notes"];
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0]["text"], "came late");
  EXPECT_FALSE(notes[0]["time"].get<std::string>().empty());
  EXPECT_EQ(notes[1]["text"], "the hand support had slipped");
  EXPECT_THAT(kerf({"session", "analyze", path("S01.h5"), "--key-file", path("k.key")}).output,
              HasSubstr("the hand support had slipped"));
  EXPECT_THAT(note("   ", 2).errors, HasSubstr("the note is empty"));
  EXPECT_THAT(note("one\ntwo", 2).errors, HasSubstr("a line break"));
  EXPECT_THAT(note(std::string(501, 'n'), 2).errors, HasSubstr("has 501 bytes, expected at most 500"));
  EXPECT_EQ(host_.look(order_)["notes"].size(), 2U) << "what is refused is not kept";
}

TEST_F(LookedAtSession, TakesNoNoteHereWhileNoneRuns) {
  EXPECT_THAT([&] { host_.note("nobody sits there"); },
              ThrowsMessage<RequestError>(HasSubstr("no session is running")));
}

}  // namespace
}  // namespace kerf::bench

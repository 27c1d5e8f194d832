// A session of an experiment, run from the studio.

#include "server/session_host.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
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

}  // namespace
}  // namespace kerf::bench

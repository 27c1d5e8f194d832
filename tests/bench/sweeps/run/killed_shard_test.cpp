// A shard that is killed, after any record or within one, loses nothing that it had and computes nothing
// twice.

#include <string>

#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

using test::Outcome;

class KilledShard : public test::SweepFolder {};

TEST_F(KilledShard, GoesOnToTheSameBytes) {
  (void)plan_of(test::walls());
  ASSERT_EQ(run_it({"-j", "1"}).exit_status, 0);
  const auto whole = merged();
  for (const char* const how : {"kill@", "tear@"}) {
    for (const int cells : {1, 7, 20}) {
      std::filesystem::remove_all(file("w.shards"));
      EXPECT_EQ(run_with(how + std::to_string(cells), {"-j", "1"}).exit_status, 128 + 9);
      const int kept = *how == 't' ? cells - 1 : cells;
      const Outcome again = run_it({"-j", "1", "--json"});
      ASSERT_EQ(again.exit_status, 0) << again.errors;
      EXPECT_EQ(nlohmann::json::parse(again.output).at("computed"), 20 - kept) << how << cells;
      EXPECT_EQ(merged(), whole) << how << cells;
    }
  }
}

TEST_F(KilledShard, MayBeKilledAgainAndAgain) {
  (void)plan_of(test::walls());
  ASSERT_EQ(run_it({"-j", "1"}).exit_status, 0);
  const auto whole = merged();
  std::filesystem::remove_all(file("w.shards"));
  int runs = 0;
  while (run_with("tear@6", {"-j", "1"}).exit_status == 128 + 9 && runs < 10) ++runs;
  EXPECT_EQ(runs, 3) << "five cells of twenty are kept each time";
  EXPECT_EQ(merged(), whole);
}

TEST(KilledShards, ComeToTheSameBytesAfterAHundredKillsAtRandomMoments) {
  const Outcome outcome = test::run({KERF_SOURCE_DIR "/scripts/kill-shards", KERF_PROGRAM, "100"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("100 kills"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("the same bytes"), std::string::npos) << outcome.output;
}

}  // namespace
}  // namespace kerf::bench

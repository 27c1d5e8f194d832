#include "pages/attempt_limit.h"

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using std::chrono::seconds;

TEST(AttemptLimit, WaitsUntilTheOldestFailureIsOutOfTheWindow) {
  AttemptLimit limit(3, seconds(60));
  const AttemptLimit::Clock::time_point begin;
  for (const int at_s : {0, 10, 20}) {
    EXPECT_EQ(limit.wait(begin + seconds(at_s)), seconds(0)) << at_s;
    limit.note_failure(begin + seconds(at_s));
  }
  EXPECT_EQ(limit.wait(begin + seconds(20)), seconds(40));
  EXPECT_EQ(limit.wait(begin + seconds(59)), seconds(1));
  EXPECT_EQ(limit.wait(begin + seconds(60)), seconds(0));
  limit.note_failure(begin + seconds(60));
  EXPECT_EQ(limit.wait(begin + seconds(60)), seconds(10));
  EXPECT_EQ(limit.wait(begin + seconds(1000)), seconds(0));
}

TEST(AttemptLimit, CountsTheLatestWhereMoreAreMadeThanAllowed) {
  AttemptLimit limit(2, seconds(10));
  const AttemptLimit::Clock::time_point begin;
  for (int at_s = 0; at_s < 6; ++at_s) limit.note_failure(begin + seconds(at_s));
  EXPECT_EQ(limit.wait(begin + seconds(6)), seconds(8));
}

}  // namespace
}  // namespace kerf::bench

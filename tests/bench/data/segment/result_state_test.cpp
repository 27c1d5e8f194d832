#include "segment/result_state.h"

#include <gtest/gtest.h>

#include "support/recordings.h"

namespace kerf::bench {
namespace {

schema::Recording with_cycles() {
  schema::Recording recording = test::punch({.seconds = 1.0});
  recording.cycles = {.axis = 0, .closing_direction = 1.0, .phases = {{.cycle = 1, .begin = 0, .end = 400}}};
  return recording;
}

TEST(ResultState, IsCurrentOfARecordingThatIsAsItWas) {
  const schema::Recording recording = with_cycles();
  const KeptState kept = kept_state(recording, 0);
  EXPECT_EQ(kept.axis, "z");
  EXPECT_EQ(state_of(as_json(kept), recording, kept.content_sha256), ResultState::current);
  EXPECT_EQ(state_of(as_json(kept), recording), ResultState::current) << "samples are not asked about";
}

TEST(ResultState, TellsOtherCyclesAndOtherSamples) {
  schema::Recording recording = with_cycles();
  const auto kept = as_json(kept_state(recording, 0));
  recording.cycles->closing_direction = -1.0;
  EXPECT_EQ(state_of(kept, recording), ResultState::other_cycles);
  EXPECT_EQ(state_of(kept, recording, "another"), ResultState::other_samples);
  EXPECT_TRUE(is_outdated(ResultState::other_cycles));
  EXPECT_FALSE(is_outdated(ResultState::current) || is_outdated(ResultState::unknown));
}

TEST(ResultState, TellsAResultFromBeforeCyclesWereSavedAlongItsAxis) {
  const schema::Recording recording = with_cycles();
  schema::Recording before = recording;
  before.cycles.reset();
  auto kept = as_json(kept_state(before, 0));
  EXPECT_TRUE(kept.at("cycles_sha256").is_null());
  EXPECT_EQ(state_of(kept, recording), ResultState::before_cycles);
  kept["axis"] = "x";
  EXPECT_EQ(state_of(kept, recording), ResultState::unknown) << "the cycles are of another axis";
}

TEST(ResultState, IsUnknownOfAResultThatSaysNothing) {
  EXPECT_EQ(state_of({{"axis", "z"}}, with_cycles(), "any"), ResultState::unknown);
}

}  // namespace
}  // namespace kerf::bench

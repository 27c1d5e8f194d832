#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/judgement.h"
#include "sealed/session_store.h"

namespace kerf::bench {
namespace {

// Made and rehearsed by the program of 27 November 2026 (b109b514): before trials could be void, gains were
// found in closed loop, staircases took turns or answers had words.
TEST(GoldenSession, OfBeforeTrialsHadRulesIsReadAsItWas) {
  const std::string folder = KERF_SOURCE_DIR "/tests/bench/sessions/golden/";
  const std::string file = folder + "session-1-rules.h5";
  const SessionStore store(file, SealKey::from_file(folder + "session-1-rules.key", derivation_of(file)),
                           SessionStore::Purpose::read);
  EXPECT_THAT(store.warnings(), testing::IsEmpty());
  EXPECT_TRUE(store.finished());
  ASSERT_EQ(store.trials().size(), 5U);
  const Protocol& protocol = store.protocol();
  EXPECT_NEAR(protocol.samples[1].gain, 7.279, 5e-4);
  EXPECT_FALSE(protocol.gain_origin) << "it was not kept";
  EXPECT_EQ(*protocol.texts, *english_texts()) << "there was no other language";
  const std::vector<std::size_t> answers{0, 0, 0, 0, 0};
  const std::vector<std::size_t> right{0, 0, 0, 1, 1};
  for (std::size_t i = 0; i < 5; ++i) {
    const RecordedTrial trial = store.trial(i);
    EXPECT_EQ(trial.what.practice, i == 0);
    EXPECT_EQ(trial.answer, answers[i]);
    EXPECT_EQ(trial.what.right(protocol), right[i]);
    EXPECT_FALSE(trial.is_void());
    EXPECT_EQ(trial.what.track, 0U);
    EXPECT_NEAR(trial.decision_s(), 0.005, 1e-9);
    EXPECT_GT(trial.trace.size(), 100U);
  }
  const Study study = study_of({&store});
  EXPECT_EQ(study.judgements.size(), 5U);
  EXPECT_FALSE(study.felt.empty()) << "what was felt is in the forces, of every version";
}

}  // namespace
}  // namespace kerf::bench

#include "sealed/apparatus_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/sealed/stored_session.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A protocol with a set-up.
SessionSetUp with_apparatus() {
  SessionSetUp up = test::set_up();
  up.protocol = test::protocol_from(test::protocol_text(
      "design = \"abx\"\ntrials = 2\n",
      "[apparatus]\nnoise = \"pink\"\nheadphones = \"closed\"\nocclusion = \"a curtain\"\n"
      "checks = [\"telephones are off\"]\n"));
  return up;
}

TEST(Apparatus, IsReadAsAListOfWhatIsConfirmed) {
  const Apparatus apparatus = with_apparatus().protocol.apparatus;
  EXPECT_EQ(apparatus.noise, MaskingNoise::pink);
  ASSERT_EQ(apparatus.items.size(), 3U);
  EXPECT_EQ(apparatus.items[0].name, "headphones");
  EXPECT_EQ(apparatus.items[0].what, "closed");
  EXPECT_EQ(apparatus.items[2].name, "check 1");
  EXPECT_TRUE(test::set_up().protocol.apparatus.items.empty());
}

TEST(Apparatus, TakesYesAndNoOfItsOwnItemsAlone) {
  const Apparatus apparatus = with_apparatus().protocol.apparatus;
  EXPECT_EQ(confirmations_in({"headphones=yes", "check 1=no"}, apparatus),
            (Confirmations{{"headphones", true}, {"check 1", false}}));
  for (const char* const given : {"headphones", "headphones=maybe", "gloves=yes", "=yes"}) {
    EXPECT_THAT(
        [&] { (void)confirmations_in({given}, apparatus); },
        ThrowsMessage<std::invalid_argument>(HasSubstr("one of 'headphones', 'occlusion', 'check 1'")));
  }
}

TEST(Apparatus, StandsInTheSessionTrueFalseAndUnknown) {
  const test::StoredSession session(with_apparatus());
  {
    SessionStore run = session.run();
    EXPECT_FALSE(noise_level_of(run.session()));
    record_apparatus(run, {{"headphones", true}, {"occlusion", false}});
    run.note("run", "sim:scissors");
    record_noise_level(run, -31.5);
    run.note("run", "sim:scissors");
    run.close();
  }
  const SessionStore store = session.read();
  EXPECT_EQ(noise_level_of(store.session()), -31.5);
  const auto items = confirmed_items({&store});
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(items[0].yes, 1U);
  EXPECT_EQ(items[0].unknown, 1U) << "of the second run nobody said anything";
  EXPECT_EQ(items[1].no, 1U);
  EXPECT_EQ(items[2].yes + items[2].no, 0U);
  EXPECT_EQ(items[2].unknown, 2U);
  EXPECT_FALSE(store.session().entries[1].time.empty());
}

}  // namespace
}  // namespace kerf::bench

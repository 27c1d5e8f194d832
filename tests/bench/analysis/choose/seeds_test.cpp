#include <atomic>
#include <string>

#include <gtest/gtest.h>

#include "choose/choose.h"
#include "known_cuts.h"
#include "known_laws.h"

// What a choice makes of recordings whose law is known, over many of them.

namespace kerf::bench {
namespace {

using test::cut_of;

const std::atomic<bool> go_on{false};

ChooseOptions quick() {
  ChooseOptions options;
  options.candidates.max_segments = 4;
  options.richer_too = false;
  return options;
}

TEST(ChooseOverSeeds, ExplainsAKnownLawByNoneThatIsRicher) {
  const auto known = test::known_laws();
  int wrong = 0;
  std::string list;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const test::KnownLaw& law = known[seed % known.size()];
    const LawChoice choice = choose_law(cut_of(law.law, {.seed = seed}), quick(), go_on);
    if (choice.serves && choice.candidates.at(*choice.taken).law.parameters <= law.parameters) continue;
    ++wrong;
    list += std::string(law.name) + ": " + choice.why + '\n';
  }
  RecordProperty("wrong", wrong);
  EXPECT_LE(wrong, 5) << list;
}

TEST(ChooseOverSeeds, ExplainsRelaxationByNoElasticLaw) {
  ChooseOptions options = quick();
  options.candidates.max_segments = 3;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const bool one_arm = seed % 2 == 0;
    const models::Law law =
        one_arm ? test::known_kelvin() : models::Law::make("maxwell", std::array{4.0, 6.0, 8.0, 0.05, 0.8});
    const LawChoice choice = choose_law(cut_of(law, {.seed = seed}), options, go_on);
    ASSERT_TRUE(choice.serves) << choice.why;
    EXPECT_TRUE(choice.candidates.at(*choice.taken).law.effects.contains(Effect::relaxation)) << choice.why;
  }
}

}  // namespace
}  // namespace kerf::bench

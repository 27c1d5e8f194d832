#include "choose/choose.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "known_cuts.h"

namespace kerf::bench {
namespace {

using models::Law;
using test::cut_of;

const std::atomic<bool> go_on{false};

/// A law that is known, with the number of parameters that a fit of it has.
struct Known {
  const char* name;
  Law law;
  std::size_t parameters;
};

const std::vector<Known>& known_laws() {
  static const std::vector<Known> all{
      {"a straight line", Law::make("piecewise", std::array{0.0, 1.0, 0.0, 8.0}, {{"segments", 1.0}}), 2},
      {"kelvin", Law::make("kelvin", std::array{5.0, 8.0, 1.6}), 3},
      {"exponential", Law::make("exponential", std::array{0.2, 0.7, 0.3}, {{"thickness", 0.1}}), 3},
      {"hunt_crossley", Law::make("hunt_crossley", std::array{0.03, 0.01, 1.5}), 3},
      {"maxwell", Law::make("maxwell", std::array{4.0, 6.0, 8.0, 0.05, 0.8}), 5},
      {"piecewise",
       Law::make("piecewise", std::array{0.0, 0.15, 0.3, 0.5, 0.1, 0.6, 2.5, 3.0}, {{"segments", 3.0}}), 6},
      {"piecewise with a loop",
       Law::make("piecewise", std::array{0.0, 0.15, 0.3, 0.5, 0.3, 0.8, 3.0, 3.5, -0.3, -0.4, -0.5, -1.0},
                 {{"segments", 3.0}, {"loop", true}}),
       10}};
  return all;
}

ChooseOptions quick() {
  ChooseOptions options;
  options.candidates.most_segments = 4;
  options.richer_too = false;
  return options;
}

const Candidate& taken_of(const LawChoice& choice) { return choice.candidates.at(choice.taken.value()); }

TEST(Choose, ExplainsAKnownLawByNoneThatIsRicher) {
  int wrong = 0;
  std::string list;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Known& known = known_laws()[seed % known_laws().size()];
    const LawChoice choice = choose_law(cut_of(known.law, {.seed = seed}), quick(), go_on);
    const bool right = choice.serves && taken_of(choice).law.parameters <= known.parameters;
    wrong += right ? 0 : 1;
    std::printf("%s: %s\n", known.name, choice.why.c_str());
    if (!right) list += std::string(known.name) + ": " + choice.why + '\n';
  }
  EXPECT_LE(wrong, 5) << list;
}

}  // namespace
}  // namespace kerf::bench

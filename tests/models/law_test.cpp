#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/models/law.h>

#include "support/allocation_counter.h"

namespace kerf::models {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// A plausible law of every kind in the registry; a law that is not listed here fails the suite.
Law example(std::string_view model) {
  if (model == "kelvin") return Law::make(model, std::vector{8.0, 7.0, 130.0});
  if (model == "exponential") return Law::make(model, std::vector{0.02, 3.0, 0.4}, {{"thickness", 0.3}});
  if (model == "piecewise") {
    return Law::make(model, std::vector{0.0, 0.1, 0.4, 0.1, 2.0, 1.5, -0.1, -1.0, -0.7},
                     {{"segments", 2.0}, {"loop", true}, {"ramp_band", 0.01}, {"reversal_scale", 40.0}});
  }
  if (model == "recording") {
    return Law::make(model, std::vector{0.1, 2.0, 1.5, -0.1, -1.0, -0.7},
                     {{"points", 3.0}, {"last", 0.4}, {"loop", true}, {"velocity_corner", 10.0}});
  }
  throw std::logic_error("no example of law " + std::string(model));
}

class EveryLaw : public testing::TestWithParam<std::string_view> {
 protected:
  const Law law = example(GetParam());
};
std::vector<std::string_view> names_of_all_laws() {
  std::vector<std::string_view> names;
  for (const LawInfo& law : registry()) names.push_back(law.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Registry, EveryLaw, testing::ValuesIn(names_of_all_laws()),
                         [](const auto& name) { return std::string(name.param); });

Motion stroke(int tick) {
  const double phase = 2e-3 * tick;
  return {.penetration = 0.2 * (1.0 - std::cos(phase)), .velocity = 0.4 * std::sin(phase)};
}

TEST_P(EveryLaw, ReplaysBitForBit) {
  std::vector<std::uint64_t> first;
  for (const bool again : {false, true}) {
    auto state = law.initial_state();
    for (int tick = 0; tick < 5000; ++tick) {
      const auto bits = std::bit_cast<std::uint64_t>(law.step(state, stroke(tick), 1e-3).force);
      if (!again) {
        first.push_back(bits);
      } else {
        ASSERT_EQ(bits, first[static_cast<std::size_t>(tick)]) << "at tick " << tick;
      }
    }
  }
}

TEST_P(EveryLaw, AllocatesNothingInAStep) {
  auto state = law.initial_state();
  const std::size_t before = test::allocations();
  for (int tick = 0; tick < 1000; ++tick) (void)law.step(state, stroke(tick), 1e-3);
  EXPECT_EQ(test::allocations(), before);
}

TEST_P(EveryLaw, AnswersNonFiniteInputWithZeroForceAndAFault) {
  auto state = law.initial_state();
  for (int tick = 0; tick < 500; ++tick) (void)law.step(state, stroke(tick), 1e-3);
  auto untouched = state;
  for (const double bad : {not_a_number, infinite, -infinite}) {
    for (const Motion& motion : {Motion{bad, 0.0}, Motion{0.1, bad}}) {
      const Response response = law.step(state, motion, 1e-3);
      EXPECT_EQ(response.force, 0.0);
      EXPECT_TRUE(response.fault);
    }
  }
  for (const double period_s : {0.0, -1e-3, not_a_number})
    EXPECT_TRUE(law.step(state, stroke(500), period_s).fault);
  const Response after = law.step(state, stroke(500), 1e-3);
  EXPECT_EQ(after.force, law.step(untouched, stroke(500), 1e-3).force) << "a bad sample leaves no trace";
}

TEST_P(EveryLaw, AnswersAnOverflowWithAFault) {
  auto state = law.initial_state();
  (void)law.step(state, {.penetration = 1e-3, .velocity = 1.0}, 1e-3);
  const Response response = law.step(state, {.penetration = 1e308, .velocity = 1e308}, 1e-3);
  EXPECT_TRUE(response.fault || std::isfinite(response.force));
  EXPECT_TRUE(!response.fault || response.force == 0.0);
}

TEST_P(EveryLaw, FaultsOnTheStateOfAnotherLaw) {
  for (const LawInfo& other : registry()) {
    if (other.name == GetParam()) continue;
    auto state = example(other.name).initial_state();
    EXPECT_TRUE(law.step(state, stroke(1), 1e-3).fault) << other.name;
  }
}

TEST_P(EveryLaw, IsMadeAgainFromItsOwnDescription) {
  const Law again = Law::make(law.model(), law.values(), law.options());
  EXPECT_EQ(again.model(), GetParam());
  EXPECT_EQ(again.values(), law.values());
  EXPECT_EQ(again.options(), law.options());
  EXPECT_EQ(law.parameters().size(), law.values().size());
}

TEST_P(EveryLaw, RefusesParametersOutsideTheirRange) {
  for (std::size_t i = 0; i < law.values().size(); ++i) {
    for (const double bad : {2e9, -2e9, not_a_number}) {
      auto values = law.values();
      values[i] = bad;
      try {
        (void)Law::make(law.model(), values, law.options());
        ADD_FAILURE() << "accepted " << bad;
      } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("'" + law.parameters()[i].name + "'"));
      }
    }
  }
}

TEST_P(EveryLaw, RefusesUnknownOptionsAndAWrongNumberOfValues) {
  auto options = law.options();
  options["magic"] = 1.0;
  EXPECT_THROW((void)Law::make(law.model(), law.values(), options), std::invalid_argument);
  EXPECT_THROW((void)Law::make(law.model(), std::vector<double>{}, law.options()), std::invalid_argument);
}

TEST(Law, AnUnknownNameIsAnsweredWithThoseThatExist) {
  try {
    (void)Law::make("maxwell", std::vector{1.0});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "unknown law 'maxwell'; the laws are kelvin, exponential, piecewise, recording");
  }
}

TEST(Units, OfParametersFollowTheAxis) {
  EXPECT_EQ(unit_of(Quantity::stiffness, "N", "m"), "N/m");
  EXPECT_EQ(unit_of(Quantity::damping, "N", "rad"), "N·s/rad");
  EXPECT_EQ(unit_of(Quantity::position, "N", "rad"), "rad");
}

}  // namespace
}  // namespace kerf::models

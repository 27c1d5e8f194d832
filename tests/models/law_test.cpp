#include <algorithm>
#include <array>
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
#include "support/example_laws.h"

namespace kerf::models {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

using test::example;

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
SpatialMotion sweep(int tick) {
  SpatialMotion motion;
  for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
    const double phase = 2e-3 * tick * (1.0 + 0.1 * static_cast<double>(axis));
    motion.position[axis] = 0.1 * std::cos(phase);
    motion.velocity[axis] = -0.2 * (1.0 + 0.1 * static_cast<double>(axis)) * std::sin(phase);
  }
  return motion;
}

/// One tick of a law of either kind: force on each axis, the first one alone for a scalar law.
SpatialResponse tick_of(const Law& law, Law::State& state, const Motion& along, const SpatialMotion& free,
                        double period_s = 1e-3) {
  if (law.is_spatial()) return law.step(state, free, period_s);
  const Response response = law.step(state, along, period_s);
  return {.force = {response.force}, .fault = response.fault};
}
SpatialResponse tick_of(const Law& law, Law::State& state, int tick, double period_s = 1e-3) {
  return tick_of(law, state, stroke(tick), sweep(tick), period_s);
}

TEST_P(EveryLaw, ReplaysBitForBit) {
  std::vector<std::array<std::uint64_t, max_law_axes>> first;
  for (const bool again : {false, true}) {
    auto state = law.initial_state();
    for (int tick = 0; tick < 5000; ++tick) {
      const auto bits =
          std::bit_cast<std::array<std::uint64_t, max_law_axes>>(tick_of(law, state, tick).force);
      if (!again) {
        first.push_back(bits);
      } else {
        ASSERT_EQ(bits, first[static_cast<std::size_t>(tick)]) << "at tick " << tick;
      }
    }
  }
}

TEST_P(EveryLaw, IsFeltSomewhereAlongTheStroke) {
  auto state = law.initial_state();
  double most = 0.0;
  for (int tick = 0; tick < 5000; ++tick) {
    for (const double force : tick_of(law, state, tick).force) most = std::max(most, std::abs(force));
  }
  EXPECT_GT(most, 1e-4);
}

TEST_P(EveryLaw, AllocatesNothingInAStep) {
  auto state = law.initial_state();
  const std::size_t before = test::allocations();
  for (int tick = 0; tick < 1000; ++tick) (void)law.step(state, stroke(tick), 1e-3);
  for (int tick = 0; tick < 1000; ++tick) (void)law.step(state, sweep(tick), 1e-3);
  EXPECT_EQ(test::allocations(), before);
}

TEST_P(EveryLaw, GoesOnAloneFromACopyOfAState) {
  auto state = law.initial_state();
  for (int tick = 0; tick < 500; ++tick) (void)tick_of(law, state, tick);
  auto copy = state;
  auto assigned = law.initial_state();
  const std::size_t before = test::allocations();
  assigned = state;
  EXPECT_EQ(test::allocations(), before) << "a state of the same law has the memory already";
  std::vector<AxisValues> first;
  for (int tick = 500; tick < 1000; ++tick) first.push_back(tick_of(law, state, tick).force);
  for (auto* const other : {&copy, &assigned}) {
    for (int tick = 500; tick < 1000; ++tick) {
      ASSERT_EQ(tick_of(law, *other, tick).force, first[static_cast<std::size_t>(tick - 500)]) << tick;
    }
  }
}

TEST_P(EveryLaw, TakesTheStateOfAnotherLawByAssignment) {
  for (const LawInfo& other : registry()) {
    auto state = example(other.name).initial_state();
    const auto own = law.initial_state();
    state = own;
    EXPECT_FALSE(tick_of(law, state, 1).fault) << other.name;
  }
}

TEST_P(EveryLaw, AnswersNonFiniteInputWithZeroForceAndAFault) {
  auto state = law.initial_state();
  for (int tick = 0; tick < 500; ++tick) (void)tick_of(law, state, tick);
  auto untouched = state;
  const auto expect_refused = [&](const SpatialResponse& response) {
    EXPECT_EQ(response.force, AxisValues{});
    EXPECT_TRUE(response.fault);
  };
  for (const double bad : {not_a_number, infinite, -infinite}) {
    for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
      SpatialMotion free = sweep(500);
      free.position[axis] = bad;
      expect_refused(tick_of(law, state, {bad, 0.0}, free));
      free = sweep(500);
      free.velocity[axis] = bad;
      expect_refused(tick_of(law, state, {0.1, bad}, free));
    }
  }
  for (const double period_s : {0.0, -1e-3, not_a_number, infinite}) {
    expect_refused(tick_of(law, state, 500, period_s));
  }
  EXPECT_EQ(tick_of(law, state, 500).force, tick_of(law, untouched, 500).force)
      << "a bad sample leaves no trace";
}

TEST_P(EveryLaw, AnswersAnOverflowWithAFault) {
  auto state = law.initial_state();
  (void)tick_of(law, state, 1);
  SpatialMotion free;
  free.position.fill(-1e308);
  free.velocity.fill(-1e308);
  const SpatialResponse response = tick_of(law, state, {.penetration = 1e308, .velocity = 1e308}, free);
  for (const double force : response.force) {
    EXPECT_TRUE(std::isfinite(force));
    EXPECT_TRUE(!response.fault || force == 0.0);
  }
}

TEST_P(EveryLaw, FaultsOnTheStateOfAnotherLaw) {
  for (const LawInfo& other : registry()) {
    if (other.name == GetParam()) continue;
    auto state = example(other.name).initial_state();
    EXPECT_TRUE(tick_of(law, state, 1).fault) << other.name;
  }
}

TEST_P(EveryLaw, FaultsOnTheMotionOfTheOtherKind) {
  auto state = law.initial_state();
  EXPECT_EQ(law.step(state, stroke(1), 1e-3).fault, law.is_spatial());
  EXPECT_EQ(law.step(state, sweep(1), 1e-3).fault, !law.is_spatial());
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

TEST_P(EveryLaw, TakesTicksTogetherAsOneByOne) {
  const std::vector<Motion> motion{{-0.1, 0.5},         {0.001, 0.5},  {0.0015, 0.5},
                                   {not_a_number, 0.0}, {0.001, -0.5}, {0.0012, 0.2}};
  const std::vector<double> period_s{1e-3, 1e-3, 0.2, 1e-3, 0.0, 1e-3};
  Law::State together = law.initial_state();
  Law::State apart = law.initial_state();
  std::vector<double> force(motion.size());
  for (const bool is_first : {true, false}) {
    law.steps(together, motion, period_s, force);
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const Response expected = law.step(apart, motion[i], period_s[i]);
      EXPECT_EQ(std::isnan(force[i]), expected.fault) << i;
      if (expected.fault) continue;
      EXPECT_EQ(force[i], expected.force) << i << (is_first ? "" : ", going on");
    }
  }
}

TEST(Law, AlongAMotionGivesWhatItsStepsGiveFromAFreshStateEachTime) {
  const Law law = Law::make("kelvin", std::vector{8.0, 7.0, 130.0});
  const std::vector<Motion> motion{{0.1, 0.5}, {0.2, 0.5}, {0.2, 0.0}};
  const std::vector<double> period_s{1e-3, 0.2, 0.1};
  Law::State state = law.initial_state();
  std::vector<double> force;
  for (std::size_t i = 0; i < motion.size(); ++i)
    force.push_back(law.step(state, motion[i], period_s[i]).force);
  EXPECT_EQ(law.along(motion, period_s), force);
  EXPECT_EQ(law.along(motion, period_s), force) << "nothing is left of the first time";
}

TEST(Law, AnUnknownNameIsAnsweredWithThoseThatExist) {
  try {
    (void)Law::make("burgers", std::vector{1.0});
    FAIL();
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_THAT(message, testing::StartsWith("unknown law 'burgers'; the laws are kelvin, maxwell, "));
    for (const LawInfo& law : registry())
      EXPECT_THAT(message, testing::HasSubstr(" " + std::string(law.name)));
  }
}

TEST(Units, OfParametersFollowTheAxis) {
  EXPECT_EQ(unit_of(Quantity::stiffness, "N", "m"), "N/m");
  EXPECT_EQ(unit_of(Quantity::damping, "N", "rad"), "N·s/rad");
  EXPECT_EQ(unit_of(Quantity::position, "N", "rad"), "rad");
  EXPECT_EQ(unit_of(Quantity::surface_damping, "N·m", "rad"), "N·s/m³") << "whatever the axis is";
}

}  // namespace
}  // namespace kerf::models

#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/drivers/velocity_filter.h>
#include <kerf/models/law.h>

#include "libkerf/opened.h"
#include "support/allocation_counter.h"
#include "support/law_paths.h"

namespace kerf {
namespace {

constexpr double period_s = 1e-3;

/// The forces along a path of a law's own, from a state on.
std::vector<double> forces(kerf_state* state, std::string_view model, std::size_t axes, int from, int ticks) {
  const test::LawPath path = test::path_of(model);
  std::vector<double> all;
  for (int tick = from; tick < from + ticks; ++tick) {
    const double share = 0.5 - 0.5 * std::cos(0.05 * tick);
    const models::AxisValues here = test::between(path.outside, path.cut, share);
    models::AxisValues force{};
    EXPECT_EQ(kerf_step_axes(state, here.data(), nullptr, period_s, force.data()), 0U);
    all.insert(all.end(), force.begin(), force.begin() + static_cast<std::ptrdiff_t>(axes));
  }
  return all;
}

class EveryState : public testing::TestWithParam<std::string> {
 protected:
  /// On the host's axis: the examples' contact is taken off, so that the paths are those of penetrations.
  test::OpenLaw law = test::opened(test::example_file(GetParam()));
  std::size_t axes = kerf_law_axis_count(law.get());
};

TEST_P(EveryState, GoesOnFromWhereItWasSaved) {
  const test::OpenState state = test::state_of(law);
  const test::OpenState saved = test::state_of(law);
  (void)forces(state.get(), GetParam(), axes, 0, 40);
  ASSERT_EQ(kerf_state_assign(saved.get(), state.get()), KERF_OK);
  kerf_state* copy = nullptr;
  ASSERT_EQ(kerf_state_copy(state.get(), &copy, nullptr, 0), KERF_OK);
  const test::OpenState copied(copy, &kerf_state_destroy);
  const auto first = forces(state.get(), GetParam(), axes, 40, 40);
  ASSERT_EQ(kerf_state_assign(state.get(), saved.get()), KERF_OK);
  EXPECT_EQ(forces(state.get(), GetParam(), axes, 40, 40), first) << "restored";
  EXPECT_EQ(forces(copy, GetParam(), axes, 40, 40), first) << "a copy is a state of its own";
}

TEST_P(EveryState, BeginsAnewWhereItIsReset) {
  const test::OpenState state = test::state_of(law);
  const auto first = forces(state.get(), GetParam(), axes, 0, 60);
  kerf_state_reset(state.get());
  EXPECT_EQ(forces(state.get(), GetParam(), axes, 0, 60), first);
}

TEST_P(EveryState, TakesNoMemoryInTheLoop) {
  const test::OpenState state = test::state_of(law);
  const test::OpenState saved = test::state_of(law);
  const test::LawPath path = test::path_of(GetParam());
  models::AxisValues force{};
  const test::NoAllocation nothing;
  for (int tick = 0; tick < 50; ++tick) {
    const models::AxisValues here = test::between(path.outside, path.reach, 0.02 * tick);
    (void)kerf_step_axes(state.get(), here.data(), nullptr, tick % 7 == 0 ? KERF_NONE : period_s,
                         force.data());
    (void)kerf_state_energy(state.get());
    (void)kerf_state_assign(saved.get(), state.get());
    if (tick % 20 == 19) (void)kerf_state_assign(state.get(), saved.get());
  }
  kerf_state_reset(state.get());
}

std::vector<std::string> models_of_library() {
  std::vector<std::string> names;
  for (std::size_t model = 0; model < kerf_model_count(); ++model) names.emplace_back(kerf_model_name(model));
  return names;
}
INSTANTIATE_TEST_SUITE_P(Libkerf, EveryState, testing::ValuesIn(models_of_library()),
                         [](const auto& of) { return of.param; });

TEST(KerfState, OfAnotherLawIsNotAssigned) {
  const test::OpenLaw law = test::parsed(test::wall);
  const test::OpenLaw other = test::parsed(test::wall);
  const test::OpenState state = test::state_of(law);
  EXPECT_EQ(kerf_state_assign(state.get(), test::state_of(other).get()), KERF_BAD_INPUT);
}

TEST(KerfState, OutlivesItsLaw) {
  test::OpenLaw law = test::parsed(test::wall);
  const test::OpenState state = test::state_of(law);
  law.reset();
  double force = 0.0;
  EXPECT_EQ(kerf_step(state.get(), 0.02, 0.0, period_s, &force), 0U);
  EXPECT_DOUBLE_EQ(force, -1.0);
}

TEST(KerfStep, PlacesTheLawWhereItsFileSays) {
  const test::OpenLaw law = test::parsed(test::wall);
  const test::OpenState state = test::state_of(law);
  double force = 5.0;
  EXPECT_EQ(kerf_step(state.get(), 0.03, 0.1, period_s, &force), 0U);
  EXPECT_DOUBLE_EQ(force, -(100.0 * 0.02 + 2.0 * 0.1)) << "20 mm deep: it pushes the position down";
  EXPECT_EQ(kerf_step_depth(state.get(), 0.03, 0.1, period_s, &force), 0U);
  EXPECT_DOUBLE_EQ(force, 100.0 * 0.03 + 2.0 * 0.1) << "30 mm deep: it resists";
}

TEST(KerfStep, FiltersTheVelocityThatTheHostLacksAsDriversDo) {
  const test::OpenLaw law = test::parsed(test::wall);
  const test::OpenState by_number = test::state_of(law);
  const test::OpenState by_array = test::state_of(law);
  const test::OpenState told = test::state_of(law);
  drivers::VelocityFilter filter;
  double now_s = 0.0;
  for (int tick = 0; tick < 500; ++tick) {
    const double elapsed_s = tick % 10 == 0 ? 2.5e-3 : period_s;
    now_s += elapsed_s;
    const double position = 0.05 + 0.03 * std::sin(8.0 * now_s);
    const double velocity = filter.update(0, position, now_s);
    filter.advance(now_s);
    double expected = 0.0;
    double one = 0.0;
    double other = 0.0;
    ASSERT_EQ(kerf_step(told.get(), position, velocity, elapsed_s, &expected), 0U);
    ASSERT_EQ(kerf_step(by_number.get(), position, KERF_NONE, elapsed_s, &one), 0U);
    ASSERT_EQ(kerf_step_axes(by_array.get(), &position, nullptr, elapsed_s, &other), 0U);
    ASSERT_EQ(one, expected);
    ASSERT_EQ(other, expected);
  }
  EXPECT_NEAR(filter.velocity(0), 0.24 * std::cos(8.0 * now_s), 0.03) << "it lags by some 8 ms";
}

TEST(KerfStep, FiltersOneAxisWhereTheHostHasTheOthers) {
  const test::OpenLaw law = test::opened(test::example_file("fuzzy_kelvin_3d"));
  const test::OpenState state = test::state_of(law);
  const test::OpenState told = test::state_of(law);
  drivers::VelocityFilter filter;
  for (int tick = 1; tick <= 200; ++tick) {
    const double now_s = tick * period_s;
    const double position[3] = {1e-4, 0.0, -0.01 * std::sin(5.0 * now_s)};
    double told_velocity[3] = {0.0, 0.001, filter.update(2, position[2], now_s)};
    filter.advance(now_s);
    double expected[3] = {};
    double force[3] = {};
    ASSERT_EQ(kerf_step_axes(told.get(), position, told_velocity, period_s, expected), 0U);
    const double velocity[3] = {0.0, 0.001, KERF_NONE};
    ASSERT_EQ(kerf_step_axes(state.get(), position, velocity, period_s, force), 0U);
    // The library adds up the time, which is here multiplied.
    for (int axis = 0; axis < 3; ++axis) ASSERT_NEAR(force[axis], expected[axis], 1e-9);
  }
}

TEST(KerfStep, RefusesATickThatCannotBeAndGoesOnAfterIt) {
  const double infinite = std::numeric_limits<double>::infinity();
  const test::OpenLaw law = test::opened(test::example_file("kelvin"));
  const test::OpenState state = test::state_of(law);
  const test::OpenState spared = test::state_of(law);
  double force = 1.0;
  double other = 1.0;
  for (int tick = 0; tick < 30; ++tick) {
    for (const auto& [position, velocity, elapsed_s] :
         std::vector<std::array<double, 3>>{{KERF_NONE, 0.0, period_s},
                                            {KERF_NONE, KERF_NONE, period_s},
                                            {infinite, 0.0, period_s},
                                            {0.4, infinite, period_s},
                                            {0.4, 0.0, 0.0},
                                            {0.4, 0.0, -1.0},
                                            {0.4, 0.0, infinite}}) {
      force = 1.0;
      EXPECT_EQ(kerf_step(state.get(), position, velocity, elapsed_s, &force), std::uint32_t{KERF_LAW_FAULT});
      EXPECT_EQ(force, 0.0);
    }
    const double position = 0.45 - 0.002 * tick;
    ASSERT_EQ(kerf_step(state.get(), position, -2.0, period_s, &force), 0U);
    ASSERT_EQ(kerf_step(spared.get(), position, -2.0, period_s, &other), 0U);
    ASSERT_EQ(force, other);
  }
}

TEST(KerfStep, KeepsWhatIsNotFiniteOutOfItsFilter) {
  const test::OpenLaw law = test::parsed(test::wall);
  const test::OpenState state = test::state_of(law);
  double force = 0.0;
  (void)kerf_step(state.get(), 0.02, KERF_NONE, period_s, &force);
  (void)kerf_step(state.get(), std::nan(""), KERF_NONE, period_s, &force);
  EXPECT_EQ(kerf_step(state.get(), 0.02, KERF_NONE, period_s, &force), 0U);
  EXPECT_DOUBLE_EQ(force, -1.0);
}

TEST(KerfStep, TakesTheTimeItselfWhereTheHostHasNone) {
  // A dashpot: the filter tells from the force how much time the library saw pass.
  const test::OpenLaw law = test::parsed(test::wall);
  const test::OpenState state = test::state_of(law);
  double force = 0.0;
  EXPECT_EQ(kerf_step(state.get(), 0.02, KERF_NONE, KERF_NONE, &force), 0U);
  EXPECT_DOUBLE_EQ(force, -1.0) << "no velocity yet";
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_EQ(kerf_step(state.get(), 0.022, KERF_NONE, KERF_NONE, &force), 0U);
  const double velocity = (-force - 1.2) / 2.0;
  EXPECT_GT(velocity, 0.0);
  EXPECT_LT(velocity, 0.002 / 0.060) << "2 mm in 60 ms or more";
}

TEST(KerfStep, OfALawInSpaceByOneNumberIsAFault) {
  const test::OpenLaw law = test::opened(test::example_file("blade"));
  const test::OpenState state = test::state_of(law);
  double force = 1.0;
  EXPECT_EQ(kerf_step(state.get(), 0.1, 0.0, period_s, &force), std::uint32_t{KERF_LAW_FAULT});
  EXPECT_EQ(force, 0.0);
}

}  // namespace
}  // namespace kerf

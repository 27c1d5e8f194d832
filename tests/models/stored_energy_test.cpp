#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/law.h>

#include "support/allocation_counter.h"
#include "support/example_laws.h"
#include "support/law_paths.h"
#include "support/wander.h"

namespace kerf::models {
namespace {

using test::between;
using test::tick_of;
using test::Wander;

/// A law along paths that begin and end outside and wander between two corners.
struct Case {
  std::string name;
  Law law;
  AxisValues outside;
  AxisValues corner;
  AxisValues other;
  double lever = 1.0;         ///< of the first axis, where its force acts at one [m]
  bool mean_of_tick = false;  ///< the force is the mean over the tick and not that at its end
  unsigned paths = 8;
  double slack_j = 1e-14;       ///< of a tick: rounding, or what the law takes at the wrong end of it
  double corner_n_per_m = 0.0;  ///< most by which the slope of the force changes at once
};

void PrintTo(const Case& of, std::ostream* out) { *out << of.name; }

Case along(std::string name, std::string_view model, const std::vector<double>& values,
           const Options& options, double outside, double deepest) {
  return {std::move(name), Law::make(model, values, options), {outside}, {outside}, {deepest}};
}
Law example_with(std::string_view model, const Options& changes) {
  const Law law = test::example(model);
  Options options = law.options();
  for (const auto& [name, value] : changes) options[name] = value;
  return Law::make(model, law.values(), options);
}

/// Laws whose force is linear between 0, 10, 20 (or not) and 30 mm.
std::vector<std::pair<std::string, Law>> tables() {
  const auto segments = [](std::vector<double> forces, bool loop) {
    const std::vector<double> knots{0.0, 0.01, 0.03};
    forces.insert(forces.begin(), knots.begin(), knots.end());
    return Law::make("piecewise", forces, {{"segments", 2.0}, {"loop", loop}});
  };
  const auto points = [](const std::vector<double>& forces, bool loop) {
    return Law::make("recording", forces, {{"points", 4.0}, {"last", 0.03}, {"loop", loop}});
  };
  return {{"piecewise", segments({0.0, 1.0, 1.5}, false)},
          {"piecewise_that_pulls", segments({0.0, 1.0, -0.5}, false)},
          {"piecewise_loop", segments({0.0, 1.0, 1.5, 0.0, 0.6, 0.7}, true)},
          {"recording", points({0.0, 0.4, 1.0, 0.9}, false)},
          {"recording_loop", points({0.0, 0.4, 1.0, 0.9, 0.0, 0.1, -0.2, 0.5}, true)}};
}

/// Laws that never give more than they took, each also where contact is lost.
std::vector<Case> passive_cases() {
  std::vector<Case> all{
      along("liver", "kelvin", {8.0, 7.0, 130.0}, {}, -2e-3, 0.03),
      along("kelvin", "kelvin", {40.0, 300.0, 15.0}, {}, -2e-3, 0.03),
      along("kelvin_float", "kelvin", {40.0, 300.0, 15.0}, {{"precision", std::string("float")}}, -2e-3,
            0.03),
      along("maxwell", "maxwell", {8.0, 300.0, 20.0, 70.0, 0.003, 0.1, 2.0}, {{"arms", 3.0}}, -2e-3, 0.03),
      along("springpot", "springpot", {8.0, 20.0, 0.3}, {}, -2e-3, 0.03),
      along("springpot_alone", "springpot", {20.0, 0.05}, {{"spring", false}}, -2e-3, 0.03),
      along("exponential", "exponential", {0.02, 3.0, 0.4}, {{"thickness", 0.03}}, -2e-3, 0.03),
      along("hunt_crossley", "hunt_crossley", {0.5, 0.4, 1.5}, {}, -2e-3, 0.03),
      along("precontact", "precontact", {300.0, 0.002}, {}, -5e-3, 0.03),
      along("friction", "friction", {-0.1, 20.0, 0.3, 0.8, 5e-4}, {}, -0.02, 0.02),
      along("fracture", "fracture", {0.0043, 4.0, 2e-4, 20.0, 1e-3}, {}, -2e-3, 0.08)};
  all[2].slack_j = 5e-9;
  for (const auto& [name, law] : tables()) {
    all.push_back({name, law, {-2e-3}, {-2e-3}, {0.03}});
    all.back().corner_n_per_m = 200.0;
    if (name.ends_with("_loop")) all.back().slack_j = 1e-10;  // the branch is that of the speed at the end
  }
  for (const char* model : {"scissors_analytic", "fuzzy_kelvin"}) {
    const auto path = test::path_of(model);
    all.push_back({model, test::example(model), path.outside, path.outside, path.cut});
  }
  all.push_back({"fuzzy_kelvin_3d",
                 test::example("fuzzy_kelvin_3d"),
                 {0.0, 0.0, 1e-3},
                 {-0.003, -0.003, 1e-3},
                 {0.01, 0.003, -0.006}});
  all.push_back({"blade",
                 test::example("blade"),
                 {0.0, 0.0, 0.125},
                 {-4e-4, -4e-4, 0.115, -2e-3, -2e-3, -2e-3},
                 {4e-4, 4e-4, 0.095, 2e-3, 2e-3, 2e-3}});
  // Along the translation alone, to which the edge belongs (ScissorsFree::stored_energy()).
  all.push_back({"scissors", test::example("scissors"), {0.2, 0.0}, {0.2, 0.0}, {0.2, 0.015}});
  all.push_back({"orthogonal",
                 example_with("orthogonal", {{"compensate", false}, {"surface", std::string("plane")}}),
                 {0.0, -0.05, 0.0},
                 {-0.05, -0.05, -0.05},
                 {0.05, -0.12, 0.05}});
  all.push_back({"scissors_mesh",
                 example_with("scissors_mesh", {{"edge", 0.02}}),
                 {0.3, 0.0},
                 {0.3, 0.0},
                 {0.3, 0.006},
                 0.28 / 7.58,
                 true,
                 3,
                 1e-9});
  all.push_back({"scissors_mesh_closing",
                 example_with("scissors_mesh", {{"edge", 0.02}}),
                 {0.3, 0.0},
                 {0.3, 0.0},
                 {0.1, 0.0},
                 0.28 / 7.58,
                 true,
                 3,
                 4e-7});
  return all;
}

/// Work of the tool on the law in a tick, which lies between what the forces at its two ends give [J].
struct Work {
  double least = 0.0;
  double most = 0.0;
};
Work work_of(const Case& along, const AxisValues& before, const AxisValues& force, const AxisValues& from,
             const AxisValues& to) {
  Work work;
  for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
    // A scalar force resists its penetration, a spatial one pushes its position up.
    const double lever = axis == 0 ? along.lever : 1.0;
    const double travel = (along.law.is_spatial() ? -lever : 1.0) * (to[axis] - from[axis]);
    const double at_end = force[axis] * travel;
    const double at_begin = along.mean_of_tick ? at_end : before[axis] * travel;
    work.least += std::min(at_begin, at_end);
    work.most += std::max(at_begin, at_end);
  }
  return work;
}

/// A law being moved: its state, and what the last tick left.
struct Moved {
  explicit Moved(const Case& of) : along(&of), state(of.law.initial_state()), place(of.outside) {}

  Work go(const SpatialMotion& motion, double period_s) {
    const AxisValues before = force;
    const SpatialResponse response = tick_of(along->law, state, motion, period_s);
    EXPECT_FALSE(response.fault);
    force = response.force;
    const Work work = work_of(*along, before, force, place, motion.position);
    place = motion.position;
    return work;
  }
  [[nodiscard]] double stored() const { return along->law.stored_energy(state); }

  /// Most that a withdrawal to the outside may have given back, and the least.
  Work given_back(double duration_s) const {
    constexpr int ticks = 400;
    Moved out = *this;
    const AxisValues from = place;
    Work back;
    for (int tick = 1; tick <= ticks; ++tick) {
      SpatialMotion motion{.position = between(from, along->outside, static_cast<double>(tick) / ticks),
                           .velocity = {}};
      for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
        motion.velocity[axis] = (along->outside[axis] - from[axis]) / duration_s;
      }
      if (tick == 1) {  // what dashpots do comes with the speed, not along the way
        Moved at_once = *this;
        SpatialMotion here = motion;
        here.position = place;
        (void)at_once.go(here, 1e-9);
        out.force = at_once.force;
      }
      const Work work = out.go(motion, duration_s / ticks);
      back.least -= work.most;
      back.most -= work.least;
    }
    return back;
  }

  const Case* along;
  Law::State state;
  AxisValues place;
  AxisValues force{};
};

class PassiveLaw : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Laws, PassiveLaw, testing::ValuesIn(passive_cases()),
                         [](const auto& of) { return of.param.name; });

TEST_P(PassiveLaw, StoresNoMoreInATickThanTheWorkDoneOnIt) {
  const Case& along = GetParam();
  for (const double period_s : {1e-3, 1e-4}) {
    for (unsigned seed = 0; seed < along.paths; ++seed) {
      const Wander path({along.outside, along.corner, along.other}, seed);
      Moved law(along);
      (void)law.go(path.at(0.0), period_s);
      double before = law.stored();
      double most = before;
      for (int tick = 1; tick * period_s <= Wander::duration_s; ++tick) {
        const AxisValues from = law.place;
        const double work = law.go(path.at(tick * period_s), period_s).most;
        const double stored = law.stored();
        most = std::max(most, stored);
        const double in_a_corner = along.corner_n_per_m * std::pow(law.place[0] - from[0], 2) / 8.0;
        ASSERT_GE(stored, 0.0) << tick;
        ASSERT_LE(stored - before, work + in_a_corner + along.slack_j)
            << "tick " << tick << " of " << period_s << " s, path " << seed;
        before = stored;
      }
      EXPECT_TRUE(most > 0.0 || along.name == "scissors_analytic");
    }
  }
}

TEST_P(PassiveLaw, GivesBackNoMoreThanItStored) {
  const Case& along = GetParam();
  constexpr double period_s = 1e-3;
  for (unsigned seed = 0; seed < along.paths; ++seed) {
    const Wander path({along.outside, along.corner, along.other}, seed);
    Moved law(along);
    for (int tick = 0; tick * period_s <= Wander::duration_s; ++tick) {
      (void)law.go(path.at(tick * period_s), period_s);
      if (tick % 50 != 0) continue;
      for (const double duration_s : {1e-4, 0.02, 1.0, 1e4}) {
        ASSERT_LE(law.given_back(duration_s).least, law.stored() + along.slack_j)
            << "within " << duration_s << " s from tick " << tick << ", path " << seed;
      }
    }
  }
}

/// Pressed in and let go so that nothing is lost: what comes back is what was stored.
void expect_all_back(const Case& along, double duration_s) {
  constexpr int ticks = 2000;
  Moved law(along);
  for (int tick = 0; tick <= ticks; ++tick) {
    SpatialMotion motion{.position = between(along.outside, along.other, static_cast<double>(tick) / ticks),
                         .velocity = {}};
    for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
      motion.velocity[axis] = (along.other[axis] - along.outside[axis]) / duration_s;
    }
    (void)law.go(motion, duration_s / ticks);
  }
  const Work back = law.given_back(duration_s);
  const double stored = law.stored();
  EXPECT_GT(stored, 0.0) << along.name;
  EXPECT_NEAR(0.5 * (back.least + back.most), stored, 0.01 * stored) << along.name;
}

TEST(StoredEnergy, IsWhatAnElasticLawGivesBack) {
  constexpr double slow_s = 1e6;
  for (const Case& one :
       {along("exponential", "exponential", {0.02, 3.0, 0.4}, {{"thickness", 0.03}}, -2e-3, 0.03),
        along("from_zero", "exponential", {0.02, 3.0, 0.4}, {{"thickness", 0.03}, {"zero_at_contact", true}},
              -2e-3, 0.03),
        along("hunt_crossley", "hunt_crossley", {0.5, 0.4, 1.5}, {}, -2e-3, 0.03),
        along("smooth", "precontact", {300.0, 0.002}, {}, -5e-3, 0.03),
        along("paper", "precontact", {300.0, 0.002}, {{"form", std::string("paper")}}, -5e-3, 0.03),
        along("kelvin", "kelvin", {40.0, 300.0, 15.0}, {}, -2e-3, 0.03),
        along("maxwell", "maxwell", {8.0, 300.0, 20.0, 70.0, 0.003, 0.1, 2.0}, {{"arms", 3.0}}, -2e-3, 0.03),
        along("fracture", "fracture", {0.0043, 4.0, 2e-4, 20.0, 1e-3}, {}, -2e-3, 0.02)}) {
    expect_all_back(one, slow_s);
  }
  for (const auto& [name, law] : tables()) {
    if (name != "recording_loop") expect_all_back({name, law, {-1e-4}, {}, {0.018}}, slow_s);
  }
  expect_all_back({"fuzzy_rupture", test::example("fuzzy_rupture"), {-1e-3}, {}, {0.014}}, slow_s);
  expect_all_back({"blade", test::example("blade"), {0.0, 0.0, 0.1}, {}, {1e-4, 2e-4, 0.1, 0.0, 0.0, 2e-3}},
                  slow_s);
  expect_all_back({"scissors", test::example("scissors"), {0.2, 0.007}, {}, {0.2, 0.01}}, slow_s);
  expect_all_back({"orthogonal",
                   example_with("orthogonal", {{"compensate", false}}),
                   {0.0, 0.3, 0.0},
                   {},
                   {0.0, 0.1, 0.0}},
                  slow_s);
}

TEST(StoredEnergy, OfSpringsBesideDashpotsComesBackAtOnce) {
  constexpr double at_once_s = 1e-7;
  expect_all_back(along("kelvin", "kelvin", {40.0, 300.0, 15.0}, {}, -2e-3, 0.03), at_once_s);
  expect_all_back(
      along("maxwell", "maxwell", {8.0, 300.0, 20.0, 70.0, 0.003, 0.1, 2.0}, {{"arms", 3.0}}, -2e-3, 0.03),
      at_once_s);
  const Law hybrid = test::example("fuzzy_kelvin");
  expect_all_back({"fuzzy_kelvin", hybrid, {-1e-4}, {}, {1.3e-3}}, at_once_s);
}

TEST(StoredEnergy, OfTheMeshComesBackWhereItIsPushedSlowly) {
  expect_all_back({"mesh", test::example("scissors_mesh"), {0.3, 0.0}, {}, {0.3, 0.006}, 0.28 / 7.58, true},
                  2.0);
}

TEST(StoredEnergy, OfAContactThatWasLeftFastIsNotThatOfItsStretchedArm) {
  // Relaxed at 20 mm and drawn out at once: arms of 320 N/m hang on the surface, which the tool does not
  // feel.
  const Law law = Law::make("kelvin", std::vector{40.0, 320.0, 32.0});
  auto state = law.initial_state();
  (void)law.step(state, Motion{}, 1.0);
  (void)law.step(state, Motion{0.02, 0.0}, 1e3);
  const double pressed = law.stored_energy(state);
  EXPECT_NEAR(pressed, 0.5 * 40.0 * 0.02 * 0.02, 1e-6);
  double regained = 0.0;
  double before = 40.0 * 0.02;
  for (int tick = 1; tick <= 2000; ++tick) {
    const double force = law.step(state, Motion{0.02 - 1e-5 * tick, 0.0}, 1e-9).force;
    regained += 0.5 * (before + force) * 1e-5;
    before = force;
  }
  EXPECT_NEAR(law.stored_energy(state), pressed - regained, 1e-6 * pressed) << "none of what nobody pulled";
  EXPECT_GT(law.stored_energy(state), 0.1 * pressed);
}

TEST(StoredEnergy, OfASpringpotThatIsDrawnOutFastOnlyFalls) {
  constexpr double step_m = 1e-4;
  for (const double order : {0.5, 0.9, 0.99}) {
    for (const double period_s : {1e-3, 1e-5, 1e-7}) {
      const Law law = Law::make("springpot", std::vector{40.0, 30.0, order});
      auto state = law.initial_state();
      (void)law.step(state, Motion{}, period_s);
      (void)law.step(state, Motion{0.02, 0.0}, 1e6);
      double before = law.stored_energy(state);
      for (double x = 0.02 - step_m; x > 0.0; x -= step_m) {
        (void)law.step(state, Motion{x, 0.0}, period_s);
        const double stored = law.stored_energy(state);
        ASSERT_LE(stored, before) << "of what the hand does not feel, order " << order << ", " << period_s
                                  << " s";
        before = stored;
      }
    }
  }
}

TEST(StoredEnergy, ShowsWhatForwardEulerMakesOfNothingAtRest) {
  // In 2.5 relaxation times a tick the arm's force goes to -1.5 times itself.
  const Law law = Law::make("kelvin", std::vector{40.0, 320.0, 32.0}, {{"integrator", std::string("euler")}});
  auto state = law.initial_state();
  (void)law.step(state, Motion{}, 0.25);
  (void)law.step(state, Motion{0.02, 0.0}, 0.25);
  double arm_n = 320.0 * 0.02;
  for (int tick = 1; tick <= 6; ++tick) {
    (void)law.step(state, Motion{0.02, 0.0}, 0.25);
    arm_n *= -1.5;
    const double springs = 0.5 * 40.0 * 0.02 * 0.02 + 0.5 * arm_n * arm_n / 320.0;
    EXPECT_NEAR(law.stored_energy(state), springs, 1e-9 * springs) << tick;
  }
}

class EveryLawsEnergy : public testing::TestWithParam<std::string> {};
std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const LawInfo& law : registry()) all.emplace_back(law.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Registry, EveryLawsEnergy, testing::ValuesIn(names()),
                         [](const auto& name) { return name.param; });

TEST_P(EveryLawsEnergy, IsSaidAlongACutAndGoneOutside) {
  const Law law = test::example(GetParam());
  const test::LawPath path = test::path_of(GetParam());
  auto state = law.initial_state();
  double most = 0.0;
  const auto go = [&](const AxisValues& from, const AxisValues& to, int ticks, double period_s) {
    for (int tick = 1; tick <= ticks; ++tick) {
      SpatialMotion motion{.position = between(from, to, static_cast<double>(tick) / ticks), .velocity = {}};
      for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
        motion.velocity[axis] = (to[axis] - from[axis]) / (ticks * period_s);
      }
      EXPECT_FALSE(tick_of(law, state, motion, period_s).fault);
      const std::size_t allocated = test::allocations();
      const double stored = law.stored_energy(state);
      ASSERT_EQ(test::allocations(), allocated);
      ASSERT_GE(stored, 0.0) << "a number, at tick " << tick;
      most = std::max(most, stored);
    }
  };
  go(path.outside, path.outside, 1, 1e-3);
  const double at_first = law.stored_energy(state);
  go(path.outside, path.pressed, 300, 1e-3);
  go(path.pressed, path.cut, 300, 1e-3);
  go(path.cut, path.reach, 300, 1e-3);
  go(path.reach, path.outside, 300, 1e-3);
  go(path.outside, path.outside, 1000, 1e-3);
  go(path.outside, path.outside, 20, 1e9);
  // Loops that resist both ways, and what is no contact.
  if (GetParam() == "friction") return;
  EXPECT_EQ(at_first, 0.0);
  EXPECT_LE(law.stored_energy(state), 1e-9 * most);
  const bool resists_both_ways =
      GetParam() == "scissors_analytic" || GetParam() == "piecewise" || GetParam() == "recording";
  EXPECT_EQ(most > 0.0, !resists_both_ways);
}

TEST(StoredEnergy, IsNotANumberWhereTheLawDoesNotSay) {
  const auto of = [](const std::vector<double>& friction) {
    const Law law = Law::make("friction", friction);
    auto state = law.initial_state();
    (void)law.step(state, Motion{0.01, 0.0}, 1e-3);
    return law.stored_energy(state);
  };
  EXPECT_TRUE(std::isnan(of({0.0, -1.0, 0.3, 0.8, 5e-4}))) << "a spring that pushes away";
  EXPECT_TRUE(std::isnan(of({0.1, 0.0, 0.3, 0.8, 5e-4}))) << "a force without an end";
  EXPECT_EQ(of({0.0, 0.0, 0.3, 0.8, 5e-4}), 0.0);
  const Law law = test::example("kelvin");
  EXPECT_TRUE(std::isnan(law.stored_energy(test::example("maxwell").initial_state())))
      << "another law's state";
  auto state = law.initial_state();
  const Law::State taken = std::move(state);
  EXPECT_TRUE(std::isnan(law.stored_energy(state)));  // NOLINT(bugprone-use-after-move): that is the case
  EXPECT_EQ(law.stored_energy(taken), 0.0);
}

}  // namespace
}  // namespace kerf::models

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/kelvin.h>
#include <kerf/models/law.h>
#include <kerf/models/maxwell.h>
#include <kerf/models/scissors_mesh.h>

#include "support/example_laws.h"
#include "support/law_paths.h"

namespace kerf::models {
namespace {

using test::between;
using test::LawPath;
using test::tick_of;

constexpr double tick_s = 1e-3;
constexpr int ticks_into_contact = 600;
constexpr int ticks_after = 1200;
const std::vector<double> stalls_s{1e-4, 1e-3, 2e-3, 5e-3, 10e-3, 50e-3, 71e-3, 72e-3, 0.1, 1.0, 10.0, 60.0};

/// A tool that goes from place to place in straight lines, tick by tick or with one long tick.
class Tool {
 public:
  Tool(const Law& law, const AxisValues& at) : law_(law), state_(law.initial_state()), at_(at) {}

  void go(const AxisValues& to, int ticks, double period_s = tick_s) {
    const AxisValues from = at_;
    for (int tick = 1; tick <= ticks; ++tick) {
      at_ = between(from, to, static_cast<double>(tick) / ticks);
      SpatialMotion motion{.position = at_, .velocity = {}};
      for (std::size_t axis = 0; axis < max_law_axes; ++axis) {
        motion.velocity[axis] = (to[axis] - from[axis]) / (ticks * period_s);
      }
      const SpatialResponse response = tick_of(law_, state_, motion, period_s);
      faults_ += response.fault ? 1 : 0;
      force_ = response.force;
      for (const double force : force_) largest_ = std::max(largest_, std::abs(force));
    }
  }

  [[nodiscard]] const AxisValues& force() const { return force_; }
  [[nodiscard]] double largest() const { return largest_; }
  [[nodiscard]] int faults() const { return faults_; }

 private:
  const Law& law_;
  Law::State state_;
  AxisValues at_;
  AxisValues force_{};
  double largest_ = 0.0;
  int faults_ = 0;
};

double difference(const AxisValues& a, const AxisValues& b) {
  double most = 0.0;
  for (std::size_t axis = 0; axis < max_law_axes; ++axis) most = std::max(most, std::abs(a[axis] - b[axis]));
  return most;
}

/// What a stall may do to the force, as a share of the largest one without it.
struct Trace {
  double pressed = 1e-6;  ///< left a second later in contact, where nothing gives way
  double cut = 1e-6;      ///< in the middle of a cut
  double most = 1.0 + 1e-9;
};
Trace trace_of(std::string_view model) {
  // The force remembers how far it is to the next rupture, or where the tissue held again, and a long tick
  // has one of them at most.
  if (model == "fuzzy_kelvin" || model == "fuzzy_kelvin_3d" || model == "blade") return {.cut = 1.0};
  // Follows up to twice as fast as the tool went.
  if (model == "scissors_mesh") return {.pressed = 1e-3, .cut = 1e-3, .most = 2.0};
  return {};
}

class EveryLawAfterAStall : public testing::TestWithParam<std::string> {};
std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const LawInfo& law : registry()) all.emplace_back(law.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Registry, EveryLawAfterAStall, testing::ValuesIn(names()),
                         [](const auto& name) { return name.param; });

/// A tool meets the tissue, is not seen for a while in which it goes on, and is then moved a little and held:
/// back where it pressed, on where it cut.
void expect_bounded(const Law& law, const LawPath& path, bool in_the_cut, const Trace& trace) {
  const AxisValues& before = in_the_cut ? path.cut : path.pressed;
  const AxisValues& after = in_the_cut ? path.reach : path.deeper;
  const AxisValues last = between(before, after, in_the_cut ? 1.02 : 0.9);
  for (const double stall_s : stalls_s) {
    const auto run = [&](double seen_s, int ticks_of_it) {
      Tool tool(law, path.outside);
      tool.go(path.pressed, ticks_into_contact / 2);
      tool.go(before, ticks_into_contact / 2);
      tool.go(after, ticks_of_it, seen_s / ticks_of_it);
      tool.go(last, 200);
      tool.go(last, ticks_after - 200);
      return tool;
    };
    // A mesh has forgotten within a second what a minute of it would tell.
    const double seen_s = law.model() == "scissors_mesh" ? std::min(stall_s, 1.0) : stall_s;
    const Tool seen = run(seen_s, std::max(1, static_cast<int>(std::lround(seen_s / tick_s))));
    const Tool stalled = run(stall_s, 1);
    const std::string where = std::to_string(1e3 * stall_s) + (in_the_cut ? " ms, cutting" : " ms, pressed");
    EXPECT_EQ(stalled.faults(), 0) << where;
    EXPECT_LE(stalled.largest(), trace.most * seen.largest()) << where;
    EXPECT_LE(difference(stalled.force(), seen.force()),
              (in_the_cut ? trace.cut : trace.pressed) * seen.largest())
        << where;
  }
}

TEST_P(EveryLawAfterAStall, IsFiniteAndBoundedAndForgetsIt) {
  const Law law = test::example(GetParam());
  const LawPath path = test::path_of(GetParam());
  const Trace trace = trace_of(GetParam());
  expect_bounded(law, path, false, trace);
  expect_bounded(law, path, true, trace);
}

/// Whether an example is felt outside: friction, a bias before the first knot, the weight of a device.
bool is_felt_in_the_air(std::string_view model) {
  return model == "friction" || model == "piecewise" || model == "recording" || model == "orthogonal" ||
         model == "scissors_analytic" || model == "scissors";
}

TEST_P(EveryLawAfterAStall, IsNotFeltWhereTheToolWasDrawnOutMeanwhile) {
  if (is_felt_in_the_air(GetParam())) return;
  const Law law = test::example(GetParam());
  const LawPath path = test::path_of(GetParam());
  for (const double stall_s : stalls_s) {
    Tool tool(law, path.outside);
    tool.go(path.pressed, ticks_into_contact / 2);
    tool.go(path.cut, ticks_into_contact / 2);
    tool.go(path.outside, 1, stall_s);
    for (int tick = 0; tick < 100; ++tick) {
      EXPECT_EQ(difference(tool.force(), {}), 0.0) << "tick " << tick << " after " << stall_s << " s";
      tool.go(path.outside, 1);
    }
    EXPECT_EQ(tool.faults(), 0);
  }
}

TEST(NominalTick, IsTheShortestButForOneThatComesAlone) {
  NominalTick nominal;
  EXPECT_EQ(nominal.after(1e-3), 1e-3);
  for (const double late_and_early_s : {60.0, 1e-5, 1e-3, 1.9e-3, 1e-4, 1e-3}) {
    EXPECT_EQ(nominal.after(late_and_early_s), 1e-3) << late_and_early_s;
  }
  for (const double faster_s : {5e-4, 5e-4}) nominal.after(faster_s);
  EXPECT_EQ(nominal.after(60.0), 5e-4);
}

/// Closes to the middle of a cut of the example, at 1 rad/s; returns the angle reached.
double cut_into(const ScissorsMesh& law, ScissorsMesh::State& state) {
  double theta = 0.6;
  for (; theta > 0.25; theta -= tick_s) (void)law.step(state, {{theta, 0.0}, {-1.0, 0.0}}, tick_s);
  return theta;
}

TEST(ScissorsMesh, DoesNoMoreInALongTickThanInTwo) {
  const Law example = test::example("scissors_mesh");
  const ScissorsMesh law = ScissorsMesh::make(example.values(), example.options());
  auto state = law.initial_state();
  double theta = cut_into(law, state);
  const int slab = state.slab_substeps;
  const int strip = state.strip_substeps;
  for (const double stall_s : stalls_s) {
    theta -= 5e-3;
    (void)law.step(state, {{theta, 0.0}, {-1.0, 0.0}}, stall_s);
    EXPECT_LE(state.slab_substeps, 2 * slab) << stall_s;
    EXPECT_LE(state.strip_substeps, 2 * strip) << stall_s;
    EXPECT_LE(state.advance_s / state.slab_substeps, step_safety * law.slab_step_s);
    EXPECT_LE(state.advance_s / state.strip_substeps, step_safety * law.strip_step_s);
    (void)law.step(state, {{theta, 0.0}, {}}, tick_s);
    EXPECT_LE(state.slab_substeps, slab) << "and nothing is left to be made up for";
  }
}

TEST(ScissorsMesh, TakesASkippedTickWhole) {
  const Law example = test::example("scissors_mesh");
  const ScissorsMesh law = ScissorsMesh::make(example.values(), example.options());
  auto state = law.initial_state();
  const double theta = cut_into(law, state);
  (void)law.step(state, {{theta - 2e-3, 0.0}, {-1.0, 0.0}}, 2.0 * tick_s);
  EXPECT_EQ(state.advance_s, 2.0 * tick_s);
  EXPECT_FALSE(state.trails);
  EXPECT_EQ(state.before.theta, theta - 2e-3);
}

TEST(ScissorsMesh, FollowsAToolThatWentFarNoFasterThanAHand) {
  const Law example = test::example("scissors_mesh");
  const ScissorsMesh law = ScissorsMesh::make(example.values(), example.options());
  auto state = law.initial_state();
  const double from = cut_into(law, state);
  double seen = state.before.theta;
  int ticks = 0;
  for (double period_s = 1.0; ticks == 0 || state.trails; period_s = tick_s, ++ticks) {
    (void)law.step(state, {{0.1, 0.005}, {}}, period_s);
    EXPECT_LE(seen - state.before.theta, 10.0 * state.advance_s * (1.0 + 1e-9));
    seen = state.before.theta;
    ASSERT_LT(ticks, 1000);
  }
  EXPECT_NEAR(ticks, (from - 0.1) / (10.0 * tick_s), 3);
  EXPECT_NEAR(state.before.theta, 0.1, 1e-12);
  EXPECT_NEAR(state.before.x_s, 0.005, 1e-12);
}

TEST(ScissorsMesh, IsNotFeltByAToolDrawnBackDuringAStall) {
  const Law law = test::example("scissors_mesh");
  for (const double stall_s : stalls_s) {
    Tool tool(law, {0.3, 0.0});
    tool.go({0.3, 0.008}, 300);
    EXPECT_LT(tool.force()[1], -0.01) << "pushes the slab";
    tool.go({0.3, -0.02}, 1, stall_s);
    for (int tick = 0; tick < 100; ++tick) {
      EXPECT_EQ(tool.force(), AxisValues{}) << "tick " << tick << " after " << stall_s << " s";
      tool.go({0.3, -0.02}, 1);
    }
  }
}

TEST(ScissorsMesh, SubstepsByHandAreAsLongInALongTick) {
  Options options = test::example("scissors_mesh").options();
  options["substeps"] = 20.0;
  const ScissorsMesh law = ScissorsMesh::make(test::example("scissors_mesh").values(), options);
  auto state = law.initial_state();
  const double theta = cut_into(law, state);
  EXPECT_EQ(state.slab_substeps, 20);
  for (const double stall_s : stalls_s) {
    (void)law.step(state, {{theta, 0.0}, {}}, stall_s);
    EXPECT_EQ(state.slab_substeps, stall_s > tick_s ? 40 : 20) << stall_s;
  }
}

TEST(ForwardEuler, TakesAStallAsTheTicksThatItMissed) {
  const auto force_after = [](auto law, bool stalled) {
    law.integrator = Integrator::euler;
    typename decltype(law)::State state;
    for (int tick = 1; tick <= 100; ++tick) (void)law.step(state, {1e-4 * tick, 0.0}, tick_s);
    const int ticks = stalled ? 1 : 2000;
    for (int tick = 1; tick <= ticks; ++tick) {
      (void)law.step(state, {0.01 + 5e-3 * tick / ticks, 0.0}, 2000.0 * tick_s / ticks);
    }
    return static_cast<double>(law.step(state, {0.015, 0.0}, tick_s));
  };
  const auto expect_alike = [&](const auto& law, double tolerance) {
    const double seen = force_after(law, false);
    EXPECT_NEAR(force_after(law, true), seen, tolerance * seen);
  };
  expect_alike(Kelvin<double>{.parallel_stiffness = 8.0, .series_stiffness = 700.0, .damping = 1.0}, 1e-9);
  expect_alike(Kelvin<double>{.parallel_stiffness = 8.0, .series_stiffness = 700.0, .damping = 1e4}, 1e-9);
  expect_alike(Kelvin<float>{.parallel_stiffness = 8.0F, .series_stiffness = 700.0F, .damping = 1.0F}, 1e-4);
  const std::vector<double> values{8.0, 300.0, 20.0, 1.5e-3, 2.0};
  expect_alike(Maxwell<double>::make(values, {{"arms", 2.0}}), 1e-9);
}

}  // namespace
}  // namespace kerf::models

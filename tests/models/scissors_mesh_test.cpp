#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/law.h>
#include <kerf/models/scissors_mesh.h>

#include "support/allocation_counter.h"

namespace kerf::models {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double period_s = 1e-3;
const std::vector<double> tissue{10.0, 5.0, 5e-5, 1e-5, 1e-3, 50.0, 0.01, 5000.0, 1e-3, 3e-4};

ScissorsMesh mesh(const Options& more = {}) {
  Options options{{"columns", 30.0}, {"rows", 20.0}, {"edge", 0.012}};
  for (const auto& [name, value] : more) options[name] = value;
  return ScissorsMesh::make(tissue, options);
}

/// Closes from 40 to 2 degrees, at 60 deg/s.
struct Stroke {
  std::vector<double> handle;
  std::vector<double> translation;
  std::vector<int> front;
};
Stroke close(const ScissorsMesh& law, ScissorsMesh::State& state, double from = 40.0 * degree,
             double to = 2.0 * degree, double x_s = 0.0) {
  Stroke stroke;
  const double rate = 60.0 * degree;
  for (double theta = from; theta > to; theta -= rate * period_s) {
    const AxisValues force = law.step(state, {{theta, x_s}, {-rate, 0.0}}, period_s);
    stroke.handle.push_back(force[0]);
    stroke.translation.push_back(force[1]);
    stroke.front.push_back(state.front);
  }
  return stroke;
}

TEST(ScissorsMesh, IsCutNodeByNodeAndSplitAtTheEnd) {
  const ScissorsMesh law = mesh();
  auto state = law.initial_state();
  const int nodes_before = state.slab.nodes();
  const Stroke stroke = close(law, state);
  for (std::size_t i = 1; i < stroke.front.size(); ++i) {
    ASSERT_GE(stroke.front[i], stroke.front[i - 1]);
    ASSERT_LE(stroke.front[i], stroke.front[i - 1] + 1) << "one element at a time at this speed";
  }
  EXPECT_NEAR(state.front, 23, 1) << "the blades end 35 mm from the pivot, the slab begins at 12 mm";
  EXPECT_FALSE(state.cutting) << "closed";
  EXPECT_EQ(state.cuts, static_cast<std::uint32_t>(state.front));
  // A cut from the border makes one node a column that it passes, its tip excepted.
  EXPECT_EQ(state.slab.nodes() - nodes_before, state.front);
  EXPECT_TRUE(state.slab.consistent());
  EXPECT_TRUE(state.strip.consistent());
  EXPECT_GT(*std::max_element(stroke.handle.begin(), stroke.handle.end()), 0.3) << "resists closing";
  EXPECT_GE(*std::min_element(stroke.handle.begin(), stroke.handle.end()), 0.0) << "and never helps it";
}

TEST(ScissorsMesh, FeelsNothingBeforeTheMaterialAndNothingWhileOpening) {
  const ScissorsMesh law = mesh({{"edge", 0.1}});
  auto state = law.initial_state();
  for (const double force : close(law, state).handle) ASSERT_EQ(force, 0.0);
  EXPECT_EQ(state.front, 0);

  const ScissorsMesh near = mesh();
  auto cut = near.initial_state();
  (void)close(near, cut, 40.0 * degree, 15.0 * degree);
  ASSERT_TRUE(cut.cutting);
  const int front = cut.front;
  const AxisValues force = near.step(cut, {{15.1 * degree, 0.0}, {60.0 * degree, 0.0}}, period_s);
  EXPECT_FALSE(cut.cutting) << "opening ends the cut";
  EXPECT_EQ(cut.cuts, static_cast<std::uint32_t>(front));
  EXPECT_EQ(force[0], 0.0);
}

TEST(ScissorsMesh, ASecondCutGoesOnWhereTheFirstEnded) {
  const ScissorsMesh law = mesh();
  auto state = law.initial_state();
  (void)close(law, state, 40.0 * degree, 15.0 * degree);
  (void)law.step(state, {{15.1 * degree, 0.0}, {1.0, 0.0}}, period_s);
  const int first = state.front;
  ASSERT_GT(first, 2);
  (void)close(law, state, 20.0 * degree, 6.0 * degree);
  EXPECT_GT(state.front, first);
  EXPECT_TRUE(state.slab.consistent());
}

TEST(ScissorsMesh, PushingForwardWithoutClosingMeetsASpringAndNoCut) {
  const ScissorsMesh law = mesh({{"edge", 0.025}});
  auto state = law.initial_state();
  const double theta = 10.0 * degree;
  const double touching = 0.025 - law.point(theta);
  double force = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    const double x_s = touching + std::min(1e-6 * tick, 1e-3);
    force = law.step(state, {{theta, x_s}, {0.0, tick < 1000 ? 1e-3 : 0.0}}, period_s)[1];
  }
  EXPECT_EQ(state.front, 0);
  // At rest the coupling and the slab are two springs in series.
  const double moved = state.slab.displacement(state.slab.node(state.slab.cell(0, 9), 0))[0];
  EXPECT_NEAR(force, -50.0 * (1e-3 - moved), 1e-4);
  EXPECT_GT(moved, 1e-4);
  for (const auto& [cell, corner] : {std::pair{state.slab.cell(0, 0), 0}, {state.slab.cell(0, 18), 3}}) {
    EXPECT_EQ(state.slab.displacement(state.slab.node(cell, corner)), (std::array{0.0, 0.0}))
        << "the sides far from the blades are held";
  }
  // Withdrawn, the slab comes back and nothing pulls.
  for (int tick = 0; tick < 2000; ++tick) {
    EXPECT_GE(0.0, law.step(state, {{theta, touching - 1e-3}, {}}, period_s)[1]);
  }
  EXPECT_NEAR(state.slab.displacement(state.slab.node(state.slab.cell(0, 9), 0))[0], 0.0, 1e-5);
}

TEST(ScissorsMesh, LetGoTheSlabSwingsAlikeWhereverTheBladesAre) {
  const ScissorsMesh law = mesh({{"edge", 0.025}});
  auto behind = law.initial_state();
  const double theta = 10.0 * degree;
  const double touching = 0.025 - law.point(theta);
  for (int tick = 0; tick < 200; ++tick) {
    (void)law.step(behind, {{theta, touching + 5e-6 * tick}, {0.0, 5e-3}}, period_s);
  }
  const SpatialMotion withdrawn{{theta, touching - 0.02}, {}};
  (void)law.step(behind, withdrawn, period_s);
  auto open = behind;
  const double wide = 2.0;
  ASSERT_FALSE(law.point.cuts_at(wide));
  const int node = behind.slab.node(behind.slab.cell(0, 9), 0);
  double swing = 0.0;
  for (int tick = 0; tick < 100; ++tick) {
    (void)law.step(behind, withdrawn, period_s);
    (void)law.step(open, {{wide, touching - 0.02}, {}}, period_s);
    const double moved = behind.slab.displacement(node)[0];
    ASSERT_NEAR(open.slab.displacement(node)[0], moved, 1e-9) << tick;
    swing = std::max(swing, std::abs(moved));
  }
  EXPECT_GT(swing, 1e-4);
  EXPECT_LT(std::abs(open.slab.displacement(node)[0]), 0.1 * swing);
}

TEST(ScissorsMesh, TheHandleFeelsTheVirtualWorkOfTheGap) {
  // dz/dtheta of the gap, against a central difference.
  const CuttingPoint point{ScissorsGeometry{}};
  for (const double theta : {8.0 * degree, 20.0 * degree, 35.0 * degree}) {
    const double x = point(theta) + 0.4e-3;
    const double h = 1e-6;
    const double difference = (point.half_gap(theta + h, x) - point.half_gap(theta - h, x)) / (2.0 * h);
    const double psi = 0.5 * theta + point.taper_angle();
    const double closed =
        (x - point(theta) * std::sin(psi) * std::sin(psi)) / (std::cos(psi) * std::cos(psi));
    EXPECT_NEAR(2.0 * difference / closed, 1.0, 1e-8);
    const double along = (point.half_gap(theta, x + h) - point.half_gap(theta, x - h)) / (2.0 * h);
    EXPECT_NEAR(along, std::tan(psi), 1e-8) << "x_s forward is x less";
  }
}

TEST(ScissorsMesh, TheWorkOfTheHandleIsWhatTheElementsHeld) {
  // An element breaks at a squeeze of d: between d k_eff d / 2 of its own and what its neighbours hold with
  // it.
  const ScissorsMesh law = mesh();
  auto state = law.initial_state();
  const double rate = 60.0 * degree;
  double work = 0.0;
  const Stroke stroke = close(law, state);
  for (const double handle : stroke.handle) work += handle * law.lever_m * rate * period_s;
  const double of_a_spring = 0.5 * (5000.0 + 5000.0) * std::pow(2.0 * 3e-4, 2);
  EXPECT_GT(work / state.front, 0.1 * of_a_spring);
  EXPECT_LT(work / state.front, 4.0 * of_a_spring);
}

TEST(ScissorsMesh, DoesNotDependMuchOnThePeriod) {
  std::vector<double> work;
  for (const double period : {2e-3, 1e-3, 2.5e-4}) {
    const ScissorsMesh law = mesh();
    auto state = law.initial_state();
    work.push_back(0.0);
    for (double theta = 40.0 * degree; theta > 2.0 * degree; theta -= 1.0 * period) {
      work.back() += law.step(state, {{theta, 0.0}, {-1.0, 0.0}}, period)[0] * law.lever_m * period;
    }
  }
  EXPECT_NEAR(work[0] / work[1], 1.0, 0.15);
  EXPECT_NEAR(work[2] / work[1], 1.0, 0.15);
}

/// Energy that the mesh takes in from the tool over a random walk of x_s and theta, and the lowest that it
/// fell. `held`: the force of a tick acts during the next one, as a loop holds it; else during its own.
struct Energy {
  double least = 0.0;
  double turnover = 0.0;
};
Energy random_walk(unsigned seed, bool held, bool closing) {
  const ScissorsMesh law = mesh({{"columns", 12.0}, {"rows", 10.0}, {"edge", 0.02}});
  auto state = law.initial_state();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Energy energy;
  double sum = 0.0;
  double x = 0.0;
  double v = 0.0;
  double theta = 15.0 * degree;
  double rate = 0.0;
  AxisValues before{};
  for (int tick = 0; tick < 2000; ++tick) {
    v = 0.98 * v + 4e-3 * normal(random);
    v -= 2.0 * period_s * x / 0.01;  // back towards the start
    if (closing) rate = 0.98 * rate + 0.1 * normal(random);
    const double next_x = x + period_s * v;
    const double next_theta = std::clamp(theta + period_s * rate, 5.0 * degree, 30.0 * degree);
    const AxisValues force = law.step(state, {{next_theta, next_x}, {rate, v}}, period_s);
    const AxisValues& acting = held ? before : force;
    const double part = -acting[1] * (next_x - x) - acting[0] * law.lever_m * (next_theta - theta);
    sum += part;
    energy.turnover += std::abs(part);
    energy.least = std::min(energy.least, sum);
    before = force;
    x = next_x;
    theta = next_theta;
  }
  return energy;
}

TEST(ScissorsMesh, GivesOutWhatItTookUnlessALoopHoldsItsForce) {
  for (const bool closing : {false, true}) {
    double own = 0.0;
    double held = 0.0;
    for (unsigned seed = 0; seed < 50; ++seed) {
      const Energy by_itself = random_walk(seed, false, closing);
      const Energy in_a_loop = random_walk(seed, true, closing);
      own = std::max(own, -by_itself.least / (by_itself.turnover + 1e-9));
      held = std::max(held, -in_a_loop.least / (in_a_loop.turnover + 1e-9));
    }
    std::cout << (closing ? "closing and pushing" : "pushing") << ": the mesh gives out up to " << 100.0 * own
              << " % of its turnover by itself, " << 100.0 * held << " % held at 1 kHz\n";
    EXPECT_LE(own, 1e-3);
    EXPECT_GT(held, own);
  }
}

TEST(ScissorsMesh, TakesAsManySubstepsAsItsStiffestSpringNeeds) {
  const ScissorsMesh law = mesh();
  const int n = law.substeps(1e-3);
  EXPECT_LE(1e-3 / n, step_safety * stable_step(law.slab, law.coupling_stiffness, law.coupling_damping));
  EXPECT_GT(1e-3 / (n - 1),
            step_safety * stable_step(law.slab, law.coupling_stiffness, law.coupling_damping));
  // stable_step() is coupling_limit() solved for the step.
  const double dt = stable_step(law.slab, 70.0, 0.01);
  EXPECT_NEAR(coupling_limit(law.slab, dt, 0.01), 70.0, 1e-6);
}

TEST(ScissorsMesh, SurvivesAThousandRandomSessions) {
  const ScissorsMesh law = mesh({{"columns", 8.0}, {"rows", 6.0}, {"edge", 0.02}});
  auto state = law.initial_state();
  const auto fresh = law.initial_state();
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    state = fresh;
    double theta = 0.5;
    double rate = 0.0;
    double x_s = 0.0;
    for (int tick = 0; tick < 200; ++tick) {
      rate = 0.95 * rate + normal(random);
      theta = std::clamp(theta + rate * period_s, 0.0, 0.8);
      x_s += 1e-4 * normal(random);
      const AxisValues force = law.step(state, {{theta, x_s}, {rate, 0.0}}, period_s);
      ASSERT_TRUE(std::isfinite(force[0]) && std::isfinite(force[1])) << seed;
      ASSERT_GE(force[0], 0.0);
    }
    if (seed % 50 == 0) {
      ASSERT_TRUE(state.slab.consistent() && state.strip.consistent()) << seed;
    }
  }
}

TEST(ScissorsMesh, ACutAllocatesNothing) {
  const ScissorsMesh law = mesh();
  auto state = law.initial_state();
  const std::size_t before = test::allocations();
  for (double theta = 40.0 * degree; theta > 2.0 * degree; theta -= 1e-3) {
    (void)law.step(state, {{theta, 0.0}, {-1.0, 0.0}}, period_s);
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(state.cuts, 0U);
}

TEST(ScissorsMesh, RefusesWhatNoMachineCouldStep) {
  for (const auto& [place, value] : {std::pair{std::size_t{3}, 1e-9}, std::pair{std::size_t{8}, 1e-9}}) {
    auto values = tissue;
    values[0] = 1e6;
    values[7] = 1e7;
    values[place] = value;
    EXPECT_THROW((void)ScissorsMesh::make(values, {}), std::invalid_argument);
  }
}

TEST(ScissorsMesh, TooFewSubstepsByHandAreAFaultAndNoSilence) {
  const Law law = Law::make("scissors_mesh", tissue,
                            {{"columns", 12.0}, {"rows", 10.0}, {"edge", 0.02}, {"substeps", 1.0}});
  auto state = law.initial_state();
  bool fault = false;
  for (int tick = 0; tick < 2000; ++tick) {
    const SpatialMotion push{{20.0 * degree, 0.005 + 1e-5 * tick}, {0.0, 0.01}};
    fault = law.step(state, push, period_s).fault;
  }
  EXPECT_TRUE(fault) << "to the end, once it has diverged";
}

TEST(ScissorsMesh, RefusesAnElementThatWouldNeverBreak) {
  auto values = tissue;
  values[9] = 5e-4;
  EXPECT_THROW((void)ScissorsMesh::make(values, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::models

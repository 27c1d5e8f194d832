#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <kerf/models/lattice.h>

#include "models/lattice_fields.h"

namespace kerf::models {
namespace {

/// What is missing from the books, relative to the work of a tool that pulls a node by 0.1 mm within 20 ms.
double unaccounted_energy(int substeps_a_tick) {
  LatticeOptions options = undamped(9, 9);
  options.bedding_n_per_m = 20.0;
  Lattice<double> lattice(options);
  Coupling tool{.node = 4 * 9 + 4, .stiffness_n_per_m = 50.0};
  constexpr double tick_s = 1e-3;
  double work = 0.0;
  for (int tick = 0; tick < 20; ++tick) {
    tool.target_m = {1e-4 * (1.0 - std::cos(0.05 * std::numbers::pi * tick)) / 2.0, 1e-6 * tick};
    const Vector next{1e-4 * (1.0 - std::cos(0.05 * std::numbers::pi * (tick + 1))) / 2.0, 1e-6 * (tick + 1)};
    for (std::size_t axis = 0; axis < 2; ++axis)
      tool.velocity_m_per_s[axis] = (next[axis] - tool.target_m[axis]) / tick_s;
    lattice.step(tick_s / substeps_a_tick, substeps_a_tick, {&tool, 1});
    for (std::size_t axis = 0; axis < 2; ++axis)
      work -= tool.force_n[axis] * (next[axis] - tool.target_m[axis]);
    tool.target_m = next;
  }
  const Vector u = lattice.displacement(tool.node);
  const double x = tool.target_m[0] - u[0], y = tool.target_m[1] - u[1];
  const double held = energy(lattice) + 0.5 * tool.stiffness_n_per_m * (x * x + y * y);
  EXPECT_GT(held, 1e-9);
  return (work - held) / held;
}
TEST(Lattice, BooksTheWorkOfACouplingToFirstOrderOfTheStep) {
  const double coarse = unaccounted_energy(20), fine = unaccounted_energy(40),
               finest = unaccounted_energy(80);
  EXPECT_LT(std::abs(coarse), 0.02);
  EXPECT_NEAR(coarse / fine, 2.0, 0.4);
  EXPECT_NEAR(fine / finest, 2.0, 0.3);
}

TEST(Lattice, CouplingIsStableWithinItsLimit) {
  // A soft lattice, whose corner is as light as any node gets: there the limit is nearly exact.
  for (const double damping : {0.0, 1e-3}) {
    const LatticeOptions options = damped_on_a_bed(6, 6);
    const double dt = 0.05 * stable_step(options);
    const double limit = coupling_limit(options, dt, damping);
    for (const double factor : {0.9, 2.0}) {
      Lattice<double> lattice(options);
      Coupling tool{.node = 0, .stiffness_n_per_m = factor * limit, .damping_n_s_per_m = damping};
      tool.target_m = {1e-4, -1e-4};
      EXPECT_EQ(lattice.admits(tool, dt), factor < 1.0);
      lattice.step(dt, 200, {&tool, 1});
      if (factor < 1.0) lattice.step(dt, 10000, {&tool, 1});
      const Vector u = lattice.displacement(0);
      EXPECT_EQ(std::hypot(u[0], u[1]) < 1e-3, factor < 1.0) << u[0];
    }
  }
}

TEST(Lattice, CouplingAtItsLimitIsStableAtEveryNodeOfACutLattice) {
  LatticeOptions options = undamped(5, 5);
  Lattice<double> whole(options);
  cut_everything(whole);
  const double dt = 0.8 * stable_step(options), limit = coupling_limit(options, dt, 0.0);
  ASSERT_GT(limit, 0.0);
  for (const int node : living_nodes(whole)) {
    Lattice<double> lattice = whole;
    Coupling tool{.node = node, .stiffness_n_per_m = 0.99 * limit, .target_m = {1e-4, 0.0}};
    lattice.step(dt, 2000, {&tool, 1});
    ASSERT_LT(energy(lattice), 1e4 * 0.5 * limit * 1e-8) << node;
  }
  EXPECT_EQ(coupling_limit(options, 1.01 * stable_step(options)), 0.0);
  EXPECT_EQ(coupling_limit(options, dt, 1e3), 0.0);
}

TEST(Lattice, CouplingsPullTogetherAndAlongTheirAxes) {
  const LatticeOptions options = damped_on_a_bed(7, 7);
  const double dt = 0.5 * stable_step(options);
  Lattice<double> one(options), two(options);
  std::array single{Coupling{.node = 24, .stiffness_n_per_m = 30.0, .target_m = {1e-4, 1e-4}}};
  std::array halves{Coupling{.node = 24, .stiffness_n_per_m = 15.0, .target_m = {1e-4, 1e-4}},
                    Coupling{.node = 24, .stiffness_n_per_m = 15.0, .target_m = {1e-4, 1e-4}}};
  one.step(dt, 50, single);
  two.step(dt, 50, halves);
  EXPECT_LT(largest_difference(one, two), 1e-18);
  EXPECT_NEAR(single[0].force_n[0], 2.0 * halves[1].force_n[0], 1e-15);
  EXPECT_LT(single[0].force_n[0], 0.0) << "the tool is pulled back";
  std::array along_x{
      Coupling{.node = 24, .stiffness_n_per_m = 30.0, .target_m = {1e-4, 1e-4}, .along = {true, false}}};
  one.reset();
  one.step(dt, 1, along_x);
  EXPECT_EQ(along_x[0].force_n[1], 0.0);
  EXPECT_EQ(one.displacement(24)[1], 0.0);
  EXPECT_GT(one.displacement(24)[0], 0.0);
}

TEST(Lattice, CouplingToADeadNodeDoesNothing) {
  Lattice<double> lattice(undamped(4, 4));
  lattice.remove_cell(0);
  for (const int node : {-1, 0, 17, lattice.node_limit()}) {
    Coupling tool{.node = node, .stiffness_n_per_m = 10.0, .target_m = {1e-4, 1e-4}, .force_n = {1.0, 1.0}};
    lattice.step(1e-6, 3, {&tool, 1});
    EXPECT_EQ(tool.force_n, (Vector{0.0, 0.0}));
    lattice.step(1e-6, 0, {&tool, 1});
    EXPECT_EQ(tool.force_n, (Vector{0.0, 0.0})) << "nor does a tick without steps";
    EXPECT_EQ(energy(lattice), 0.0);
  }
}

}  // namespace
}  // namespace kerf::models

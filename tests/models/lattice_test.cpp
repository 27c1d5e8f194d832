#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <kerf/models/lattice.h>

#include "models/lattice_fields.h"
#include "support/allocation_counter.h"

namespace kerf::models {
namespace {

/// One step of semi-implicit Euler, written out.
void plain_step(const Lattice<double>& lattice, Field& u, Field& v, double dt,
                const std::set<int>& held = {}) {
  const LatticeOptions& options = lattice.options();
  const Field force = forces(lattice, u, v, options.damping_time_s, options.bedding_time_s);
  for (const int node : living_nodes(lattice)) {
    if (held.contains(node)) continue;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      v[at(node)][axis] += dt * force[at(node)][axis] / lattice.mass(node);
      u[at(node)][axis] += dt * v[at(node)][axis];
    }
  }
}

/// Squared frequency of the lattice's largest mode, by power iteration.
double largest_mode(const Lattice<double>& lattice) {
  Lattice<double> copy = lattice;
  shake(copy);
  Field u = displacements(copy);
  double mode = 0.0;
  for (int i = 0; i < 2000; ++i) {
    Field next = spring_forces(copy, u);
    for (const int node : living_nodes(copy)) {
      for (double& component : next[at(node)]) component /= -copy.mass(node);
    }
    mode = std::sqrt(dot(next, next) / dot(u, u));
    const double scale = 1.0 / std::sqrt(dot(next, next));
    for (Vector& vector : next) vector = {vector[0] * scale, vector[1] * scale};
    u = next;
  }
  return mode;
}

TEST(Lattice, StretchedEvenlyPullsOnItsBordersAlone) {
  const LatticeOptions options = undamped(7, 6);
  Lattice<double> lattice(options);
  constexpr double strain = 1e-3;
  for (const int node : living_nodes(lattice))
    lattice.set_displacement(node, {strain * lattice.position(node)[0], 0.0});
  const double k = options.stiffness_n_per_m, kd = options.diagonal_stiffness_n_per_m;
  const double stretch = strain * options.spacing_m;
  const Vector inside = lattice.force(2 * 7 + 3), right = lattice.force(2 * 7 + 6),
               top = lattice.force(5 * 7 + 3);
  EXPECT_NEAR(inside[0], 0.0, 1e-12);
  EXPECT_NEAR(inside[1], 0.0, 1e-12);
  EXPECT_NEAR(right[0], -(k + kd) * stretch, 1e-12);
  EXPECT_NEAR(right[1], 0.0, 1e-12);
  EXPECT_NEAR(top[0], 0.0, 1e-12);
  EXPECT_NEAR(top[1], -kd * stretch, 1e-12);
  const double area_work = 0.5 * (k + kd) * stretch * stretch;
  EXPECT_NEAR(lattice.potential_energy(), area_work * lattice.cells(), 1e-15);
}

TEST(Lattice, CarriesPlaneWavesAtTheirClosedFormFrequency) {
  // Half a wave between two walls, so tall that the free ends are not heard in the middle within a period.
  const LatticeOptions options = undamped(9, 101);
  Lattice<double> lattice(options);
  for (int row = 0; row < 101; ++row) {
    lattice.pin(0, row);
    lattice.pin(8, row);
    for (int column = 1; column < 8; ++column)
      lattice.set_displacement(row * 9 + column, {1e-5 * std::sin(std::numbers::pi * column / 8.0), 0.0});
  }
  const double speed =
      options.spacing_m *
      std::sqrt((options.stiffness_n_per_m + options.diagonal_stiffness_n_per_m) / options.node_mass_kg);
  const double frequency = 2.0 * speed / options.spacing_m * std::sin(std::numbers::pi / 16.0);
  const double period_s = 2.0 * std::numbers::pi / frequency;
  EXPECT_NEAR(period_s, 16.0 * options.spacing_m / speed, 0.01 * period_s) << "a long wave goes at speed c";
  constexpr int steps = 400;
  const double dt = period_s / steps, angle = 2.0 * std::asin(0.5 * dt * frequency);
  for (int n = 1; n <= steps; ++n) {
    lattice.step(dt, 1);
    const double expected = 1e-5 * std::cos((n + 0.5) * angle) / std::cos(0.5 * angle);
    ASSERT_NEAR(lattice.displacement(50 * 9 + 4)[0], expected, 1e-11) << "at step " << n;
  }
}

TEST(Lattice, KeepsItsMomentumWithoutABed) {
  LatticeOptions options = undamped(12, 9);
  options.damping_time_s = 5e-5;
  Lattice<double> lattice(options);
  shake(lattice);
  lattice.cut_side(lattice.cell(4, 4), lattice.cell(4, 5));
  lattice.cut_side(lattice.cell(5, 4), lattice.cell(5, 5));
  const Vector before = momentum(lattice);
  lattice.step(0.9 * stable_step(options), 5000);
  EXPECT_NEAR(momentum(lattice)[0], before[0], 1e-16);
  EXPECT_NEAR(momentum(lattice)[1], before[1], 1e-16);
  EXPECT_GT(std::abs(before[0]), 1e-7);
}

TEST(Lattice, KeepsItsDiscreteEnergyWithoutDamping) {
  LatticeOptions options = undamped(10, 8);
  options.bedding_n_per_m = 20.0;
  Lattice<double> lattice(options);
  shake(lattice);
  const double dt = 0.99 * stable_step(options), before = discrete_energy(lattice, dt);
  for (int tick = 0; tick < 100; ++tick) {
    lattice.step(dt, 100);
    ASSERT_NEAR(discrete_energy(lattice, dt), before, 1e-10 * before);
    ASSERT_LT(energy(lattice), before / (1.0 - 0.99));
  }
}

TEST(Lattice, LosesEnergyByDampingAtEveryStep) {
  const LatticeOptions options = damped_on_a_bed(10, 8);
  Lattice<double> lattice(options);
  shake(lattice);
  const double dt = 0.99 * stable_step(options);
  const double first = energy(lattice);
  double last = discrete_energy(lattice, dt);
  for (int step = 0; step < 2000; ++step) {
    lattice.step(dt, 1);
    const double now = discrete_energy(lattice, dt);
    ASSERT_LE(now, last * (1.0 + 1e-12)) << "at step " << step;
    last = now;
  }
  lattice.step(dt, 8000);
  EXPECT_LT(energy(lattice), 1e-6 * first);
}

TEST(Lattice, DivergesBeyondTheLimitOfItsLargestMode) {
  const LatticeOptions options = undamped(10, 8);
  Lattice<double> lattice(options);
  const double limit = 2.0 / std::sqrt(largest_mode(lattice));
  EXPECT_GT(limit, stable_step(options));
  shake(lattice);
  const double before = energy(lattice);
  Lattice<double> slower = lattice;
  lattice.step(1.5 * limit, 100);
  slower.step(0.99 * limit, 10000);
  EXPECT_GT(energy(lattice), 1e20 * before);
  EXPECT_LT(energy(slower), 100.0 * before);
}

TEST(Lattice, StableStepIsExactForASingleCell) {
  for (const LatticeOptions& options : {undamped(2, 2), damped_on_a_bed(2, 2)}) {
    for (const double factor : {0.999, 1.001}) {
      Lattice<double> lattice(options);
      shake(lattice);
      const double before = energy(lattice);
      lattice.step(factor * stable_step(options), 3000);
      if (factor < 1.0) {
        EXPECT_LT(energy(lattice), 1e3 * before);
      } else {
        EXPECT_GT(energy(lattice), 1e6 * before);
      }
    }
  }
  EXPECT_NEAR(stable_step(undamped(2, 2)), 1.0 / std::sqrt(220.0 / 1e-5), 1e-12);
}

TEST(Lattice, SplitsAPeriodIntoStepsWithAReserve) {
  const LatticeOptions options = damped_on_a_bed(5, 5);
  const double longest = 0.9 * stable_step(options);
  for (const double period_s : {1e-6, 1e-3, 0.04}) {
    const int number = substeps(options, period_s);
    EXPECT_LE(period_s / number, longest * (1.0 + 1e-12));
    if (number > 1) {
      EXPECT_GT(period_s / (number - 1), longest);
    }
  }
  for (const double bad : {0.0, -1e-3, 1e9, std::nan("")})
    EXPECT_THROW((void)substeps(options, bad), std::invalid_argument);
}

TEST(Lattice, StepsAsItsCellsDoWrittenOut) {
  for (const bool with_cuts : {false, true}) {
    Lattice<double> lattice(damped_on_a_bed(11, 9));
    if (with_cuts) {
      for (int column = 0; column < 6; ++column)
        lattice.cut_side(lattice.cell(column, 3), lattice.cell(column, 4));
      for (int row = 2; row < 8; ++row) lattice.cut_side(lattice.cell(4, row), lattice.cell(5, row));
      lattice.remove_cell(lattice.cell(8, 6));
      lattice.remove_cell(lattice.cell(9, 7));
    }
    lattice.pin(3, 3);
    lattice.pin(10, 0);
    shake(lattice);
    Field u = displacements(lattice), v = velocities(lattice);
    std::set<int> held;
    for (int slot = 0; slot < 4; ++slot) {
      held.insert(slot * 99 + 3 * 11 + 3);
      held.insert(slot * 99 + 10);
    }
    const double dt = 0.9 * stable_step(lattice.options());
    const Field force = forces(lattice, u, v, 5e-5, 3e-5);
    for (const int node : living_nodes(lattice)) {
      ASSERT_NEAR(lattice.force(node)[0], force[at(node)][0], 1e-14) << node;
      ASSERT_NEAR(lattice.force(node)[1], force[at(node)][1], 1e-14) << node;
    }
    for (int step = 0; step < 200; ++step) plain_step(lattice, u, v, dt, held);
    lattice.step(dt, 200);
    for (const int node : living_nodes(lattice)) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        ASSERT_NEAR(lattice.displacement(node)[axis], u[at(node)][axis], 1e-12 * 1e-4) << node;
        ASSERT_NEAR(lattice.velocity(node)[axis], v[at(node)][axis], 1e-12) << node;
      }
    }
  }
}

TEST(Lattice, AgreesInFloatAndDouble) {
  const LatticeOptions options = damped_on_a_bed(20, 20);
  Lattice<float> narrow(options);
  Lattice<double> wide(options);
  const auto prepare = [](auto& lattice) {
    for (int column = 3; column < 16; ++column)
      lattice.cut_side(lattice.cell(column, 9), lattice.cell(column, 10));
    shake(lattice);
  };
  prepare(narrow);
  prepare(wide);
  const double dt = 0.9 * stable_step(options);
  narrow.step(dt, 100);
  wide.step(dt, 100);
  double most = 0.0;
  for (const Vector& u : displacements(wide)) most = std::max({most, std::abs(u[0]), std::abs(u[1])});
  EXPECT_LT(largest_difference(narrow, wide), 1e-4 * most);
}

#ifdef __SSE2__
TEST(Lattice, ComesToRestWithoutNumbersBelowTheNormalRange) {
  LatticeOptions options = damped_on_a_bed(10, 10);
  options.bedding_time_s = 1e-4;
  Lattice<float> lattice(options);
  lattice.set_displacement(44, {1e-3, 1e-3});
  lattice.step(0.9 * stable_step(options), 20000);
  for (const Field& field : {displacements(lattice), velocities(lattice)}) {
    for (const Vector& vector : field) {
      for (const double component : vector)
        ASSERT_NE(std::fpclassify(static_cast<float>(component)), FP_SUBNORMAL);
    }
  }
  EXPECT_LT(energy(lattice), 1e-60);
}
#endif

TEST(Lattice, IsCopiedDeeplyAndReset) {
  Lattice<double> lattice(damped_on_a_bed(7, 7));
  const double dt = 0.9 * stable_step(lattice.options());
  const auto run = [&](Lattice<double>& one) {
    shake(one);
    for (int column = 1; column < 5; ++column) one.cut_side(one.cell(column, 2), one.cell(column, 3));
    one.remove_cell(one.cell(3, 3));
    one.step(dt, 100);
  };
  Lattice<double> copy = lattice;
  run(lattice);
  EXPECT_EQ(energy(copy), 0.0);
  EXPECT_EQ(copy.nodes(), 49);
  run(copy);
  EXPECT_EQ(displacements(copy), displacements(lattice));
  lattice.reset();
  EXPECT_TRUE(lattice.consistent());
  EXPECT_EQ(energy(lattice), 0.0);
  EXPECT_EQ(lattice.nodes(), 49);
  run(lattice);
  EXPECT_EQ(displacements(copy), displacements(lattice)) << "bit for bit";
}

template <typename Real>
void cut_and_step_without_allocating() {
  const Lattice<Real> original(damped_on_a_bed(8, 8));
  Lattice<Real> lattice = original;
  const auto all = sides(lattice);
  Coupling coupling{.node = 20, .stiffness_n_per_m = 1.0};
  const double dt = 0.9 * stable_step(lattice.options());
  const std::size_t before = test::allocations();
  for (const auto& [cell, neighbour] : all) {
    lattice.cut_side(cell, neighbour);
    lattice.step(dt, 2, {&coupling, 1});
  }
  for (int cell = 0; cell < lattice.cells(); ++cell) lattice.remove_cell(cell);
  lattice.reset();
  EXPECT_EQ(test::allocations(), before);
}
TEST(Lattice, AllocatesNothingInStepsAndCuts) {
  cut_and_step_without_allocating<float>();
  cut_and_step_without_allocating<double>();
}

TEST(Lattice, RefusesOptionsOutsideTheirRangeInASentence) {
  const auto message_for = [](auto&& spoil) {
    LatticeOptions options = undamped(4, 4);
    spoil(options);
    try {
      (void)stable_step(options);
    } catch (const std::invalid_argument&) {
    }
    try {
      const Lattice<float> lattice(options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message_for([](auto& o) { o.columns = 1; }),
            "option 'columns' of the lattice is 1, expected a number from 2 to 1000");
  EXPECT_EQ(message_for([](auto& o) { o.rows = 1001; }),
            "option 'rows' of the lattice is 1001, expected a number from 2 to 1000");
  EXPECT_EQ(message_for([](auto& o) { o.stiffness_n_per_m = 0.0; }),
            "option 'stiffness_n_per_m' of the lattice is 0, expected a number above 0");
  EXPECT_EQ(message_for([](auto& o) { o.damping_time_s = -1.0; }),
            "option 'damping_time_s' of the lattice is -1, expected a number not below 0");
  for (const double bad : {std::nan(""), -1.0, HUGE_VAL}) {
    EXPECT_NE(message_for([&](auto& o) { o.spacing_m = bad; }), "");
    EXPECT_NE(message_for([&](auto& o) { o.node_mass_kg = bad; }), "");
    EXPECT_NE(message_for([&](auto& o) { o.diagonal_stiffness_n_per_m = bad; }), "");
    EXPECT_NE(message_for([&](auto& o) { o.bedding_n_per_m = bad; }), "");
    EXPECT_NE(message_for([&](auto& o) { o.bedding_time_s = bad; }), "");
  }
}

}  // namespace
}  // namespace kerf::models

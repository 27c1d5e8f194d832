#include <map>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/lattice.h>

#include "models/lattice_fields.h"

namespace kerf::models {
namespace {

/// Whether corners have the same node exactly where they hang together through the sides left, found by
/// merging.
bool joined_as_cut(const Lattice<double>& lattice, const std::set<std::pair<int, int>>& cut) {
  std::vector<int> group(4 * at(lattice.cells()));
  std::iota(group.begin(), group.end(), 0);
  const auto root = [&](int i) {
    while (group[at(i)] != i) i = group[at(i)];
    return i;
  };
  const auto merge = [&](int a, int b) { group[at(root(a))] = root(b); };
  for (const auto& side : sides(lattice)) {
    const auto& [cell, neighbour] = side;
    if (cut.contains(side) || !lattice.living(cell) || !lattice.living(neighbour)) continue;
    const bool beside = neighbour == cell + 1;
    merge(4 * cell + 2, 4 * neighbour + (beside ? 3 : 1));
    merge(4 * cell + (beside ? 1 : 3), 4 * neighbour);
  }
  std::map<int, int> node_of, group_of;
  for (int cell = 0; cell < lattice.cells(); ++cell) {
    if (!lattice.living(cell)) continue;
    for (int i = 0; i < 4; ++i) {
      const int node = lattice.node(cell, i), own = root(4 * cell + i);
      if (node_of.emplace(own, node).first->second != node) return false;
      if (group_of.emplace(node, own).first->second != own) return false;
    }
  }
  return static_cast<int>(group_of.size()) == lattice.nodes();
}

TEST(Lattice, AnyCutsKeepItWholeInItsPartsAndStable) {
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const int columns = 3 + below(4), rows = 3 + below(4);
    const LatticeOptions options = undamped(columns, rows);
    Lattice<double> lattice(options);
    shake(lattice, seed);
    const double dt = 0.99 * stable_step(options);
    const double most = discrete_energy(lattice, dt);
    const auto all = sides(lattice);
    std::set<std::pair<int, int>> cut;
    double mass = total_mass(lattice);
    for (int round = 0; round < 5; ++round) {
      const Vector before = momentum(lattice);
      for (int i = 1 + below(8); i > 0; --i) {
        const auto side = all[at(below(static_cast<int>(all.size())))];
        const bool possible =
            !cut.contains(side) && lattice.living(side.first) && lattice.living(side.second);
        ASSERT_EQ(lattice.cut_side(side.first, side.second), possible);
        if (possible) cut.insert(side);
      }
      for (std::size_t axis = 0; axis < 2; ++axis) ASSERT_NEAR(momentum(lattice)[axis], before[axis], 1e-18);
      ASSERT_NEAR(total_mass(lattice), mass, 1e-18);
      for (int i = below(3); i > 0; --i) {
        const int cell = below(lattice.cells());
        const bool possible = lattice.living(cell);
        if (possible) mass -= options.node_mass_kg;
        ASSERT_EQ(lattice.remove_cell(cell), possible);
      }
      ASSERT_NEAR(total_mass(lattice), mass, 1e-18);
      ASSERT_TRUE(lattice.consistent()) << "seed " << seed;
      ASSERT_TRUE(joined_as_cut(lattice, cut)) << "seed " << seed;
      lattice.step(dt, 20);
    }
    lattice.step(dt, 200);
    ASSERT_LE(discrete_energy(lattice, dt), most * (1.0 + 1e-9)) << "seed " << seed;
    ASSERT_LT(energy(lattice), most / (1.0 - 0.99)) << "seed " << seed;
  }
}

TEST(Lattice, SaysItsEnergyWhateverIsCut) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    LatticeOptions options = damped_on_a_bed(24, 7);
    Lattice<double> lattice(options);
    shake(lattice, seed);
    const double dt = 0.5 * stable_step(options);
    const auto all = sides(lattice);
    for (int round = 0; round < 6; ++round) {
      const double whole = written_out_energy(lattice), discrete = discrete_energy(lattice, dt);
      ASSERT_NEAR(energy(lattice), whole, 1e-12 * whole);
      ASSERT_NEAR(lattice.energy(0.0), whole, 1e-12 * whole);
      ASSERT_NEAR(lattice.energy(dt), discrete, 1e-12 * whole) << "seed " << seed << ", round " << round;
      const auto side = all[random() % all.size()];
      (void)lattice.cut_side(side.first, side.second);
      if (round == 3) (void)lattice.remove_cell(side.first);
      lattice.step(dt, 3);
    }
  }
}

TEST(Lattice, CutIntoCellsEachKeepsItsMomentum) {
  LatticeOptions options = undamped(6, 5);
  options.damping_time_s = 5e-5;
  Lattice<double> lattice(options);
  cut_everything(lattice);
  ASSERT_TRUE(lattice.consistent());
  ASSERT_EQ(lattice.nodes(), 4 * lattice.cells());
  shake(lattice);
  const auto of_cell = [&](int cell) {
    Vector sum{};
    for (int i = 0; i < 4; ++i) {
      const Vector v = lattice.velocity(lattice.node(cell, i));
      for (std::size_t axis = 0; axis < 2; ++axis) sum[axis] += v[axis];
    }
    return sum;
  };
  std::vector<Vector> before;
  before.reserve(at(lattice.cells()));
  for (int cell = 0; cell < lattice.cells(); ++cell) before.push_back(of_cell(cell));
  lattice.step(0.9 * stable_step(options), 2000);
  for (int cell = 0; cell < lattice.cells(); ++cell) {
    EXPECT_NEAR(of_cell(cell)[0], before[at(cell)][0], 1e-11);
    EXPECT_NEAR(of_cell(cell)[1], before[at(cell)][1], 1e-11);
  }
}

TEST(Lattice, CutThroughAHalfNoLongerFeelsTheOther) {
  Lattice<double> lattice(undamped(8, 8));
  for (int column = 0; column < 7; ++column)
    lattice.cut_side(lattice.cell(column, 3), lattice.cell(column, 2));
  EXPECT_EQ(lattice.nodes(), 64 + 8);
  for (int column = 0; column < 7; ++column) {
    for (int i = 0; i < 4; ++i) lattice.set_velocity(lattice.node(lattice.cell(column, 0), i), {1.0, -2.0});
  }
  lattice.step(0.9 * stable_step(lattice.options()), 500);
  double above = 0.0, below = 0.0;
  for (int cell = 0; cell < lattice.cells(); ++cell) {
    for (int i = 0; i < 4; ++i) {
      const Vector u = lattice.displacement(lattice.node(cell, i));
      (cell >= lattice.cell(0, 3) ? above : below) += std::abs(u[0]) + std::abs(u[1]);
    }
  }
  EXPECT_EQ(above, 0.0);
  EXPECT_GT(below, 1e-3);
}

TEST(Lattice, GivesBothBanksOfACutTheMotionOfTheNodeTheyWere) {
  Lattice<double> lattice(undamped(5, 5));
  shake(lattice);
  const int old = lattice.node(lattice.cell(0, 1), 3);  // on the left border, where one cut parts two cells
  const Vector u = lattice.displacement(old), v = lattice.velocity(old);
  ASSERT_TRUE(lattice.cut_side(lattice.cell(0, 1), lattice.cell(0, 2)));
  const int lower = lattice.node(lattice.cell(0, 1), 3), upper = lattice.node(lattice.cell(0, 2), 0);
  EXPECT_NE(lower, upper);
  EXPECT_EQ(lattice.nodes(), 26);
  for (const int bank : {lower, upper}) {
    EXPECT_EQ(lattice.displacement(bank), u);
    EXPECT_EQ(lattice.velocity(bank), v);
    EXPECT_EQ(lattice.mass(bank), 0.25 * lattice.options().node_mass_kg);
  }
  EXPECT_EQ(lattice.node(lattice.cell(0, 1), 2), lattice.node(lattice.cell(0, 2), 1))
      << "the tip holds together";
}

TEST(Lattice, CanBeRemovedEntirely) {
  Lattice<double> lattice(damped_on_a_bed(5, 4));
  shake(lattice);
  for (int cell = 0; cell < lattice.cells(); ++cell) EXPECT_TRUE(lattice.remove_cell(cell));
  EXPECT_TRUE(lattice.consistent());
  EXPECT_EQ(lattice.nodes(), 0);
  lattice.step(stable_step(lattice.options()), 10);
  EXPECT_TRUE(lattice.consistent());
  EXPECT_EQ(energy(lattice), 0.0);
}

TEST(Lattice, RefusesCutsWhereThereIsNoSide) {
  Lattice<double> lattice(undamped(5, 4));
  const int last_of_row = lattice.cell(3, 0);
  EXPECT_FALSE(lattice.cut_side(last_of_row, last_of_row + 1)) << "the next number lies in the next row";
  EXPECT_FALSE(lattice.cut_side(0, 0));
  EXPECT_FALSE(lattice.cut_side(0, 5)) << "a corner is no side";
  EXPECT_FALSE(lattice.cut_side(-1, 0));
  EXPECT_FALSE(lattice.cut_side(lattice.cells() - 1, lattice.cells() + 3));
  EXPECT_TRUE(lattice.cut_side(1, 0));
  EXPECT_FALSE(lattice.cut_side(0, 1));
  EXPECT_TRUE(lattice.remove_cell(6));
  EXPECT_FALSE(lattice.remove_cell(6));
  EXPECT_FALSE(lattice.remove_cell(-1));
  EXPECT_FALSE(lattice.cut_side(6, 7));
  EXPECT_FALSE(lattice.pin(5, 0));
  EXPECT_TRUE(lattice.consistent());
}

TEST(Lattice, HoldsPinnedPointsAlsoWhereTheyAreCut) {
  Lattice<double> lattice(undamped(6, 6));
  ASSERT_TRUE(lattice.pin(2, 2));
  shake(lattice);
  lattice.set_displacement(2 * 6 + 2, {2e-4, -1e-4});
  const int below = lattice.cell(1, 1), above = lattice.cell(1, 2);
  for (const int cell : {below, below + 1}) EXPECT_TRUE(lattice.cut_side(cell, cell + (above - below)));
  Coupling tool{.node = 2 * 6 + 2, .stiffness_n_per_m = 1.0, .target_m = {1.2e-3, -1e-4}};
  lattice.step(0.9 * stable_step(lattice.options()), 100, {&tool, 1});
  EXPECT_NEAR(tool.force_n[0], -1e-3, 1e-12) << "the tool feels what it cannot move";
  int held = 0;
  for (int slot = 0; slot < 4; ++slot) {
    const int node = slot * 36 + 2 * 6 + 2;
    if (!lattice.alive(node)) continue;
    ++held;
    EXPECT_EQ(lattice.displacement(node), (Vector{2e-4, -1e-4}));
    EXPECT_EQ(lattice.velocity(node), (Vector{0.0, 0.0}));
  }
  EXPECT_EQ(held, 2);
  EXPECT_TRUE(lattice.consistent());
}

}  // namespace
}  // namespace kerf::models

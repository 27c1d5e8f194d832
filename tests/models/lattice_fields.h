#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/models/lattice.h>

/// What the tests of the lattice measure on it, written out node by node and cell by cell.
namespace kerf::models {

using Vector = std::array<double, 2>;
using Field = std::vector<Vector>;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Undamped and free; each test adds what it is about.
inline LatticeOptions undamped(int columns, int rows) {
  return {.columns = columns,
          .rows = rows,
          .spacing_m = 1e-3,
          .stiffness_n_per_m = 100.0,
          .diagonal_stiffness_n_per_m = 60.0,
          .node_mass_kg = 1e-5,
          .damping_time_s = 0.0};
}
inline LatticeOptions damped_on_a_bed(int columns, int rows) {
  LatticeOptions options = undamped(columns, rows);
  options.damping_time_s = 5e-5;
  options.bedding_n_per_m = 20.0;
  options.bedding_time_s = 3e-5;
  return options;
}

template <typename Real>
std::vector<int> living_nodes(const Lattice<Real>& lattice) {
  std::vector<int> nodes;
  for (int node = 0; node < lattice.node_limit(); ++node) {
    if (lattice.alive(node)) nodes.push_back(node);
  }
  return nodes;
}

template <typename Real>
void shake(Lattice<Real>& lattice, unsigned seed = 1) {
  std::mt19937 random(seed);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  for (const int node : living_nodes(lattice)) {
    const double ux = number(), uy = number(), vx = number(), vy = number();
    lattice.set_displacement(node, {1e-4 * ux, 1e-4 * uy});
    lattice.set_velocity(node, {0.3 * vx, 0.3 * vy});
  }
}

template <typename Real>
Field displacements(const Lattice<Real>& lattice) {
  Field field;
  for (int node = 0; node < lattice.node_limit(); ++node) field.push_back(lattice.displacement(node));
  return field;
}
template <typename Real>
Field velocities(const Lattice<Real>& lattice) {
  Field field;
  for (int node = 0; node < lattice.node_limit(); ++node) field.push_back(lattice.velocity(node));
  return field;
}

inline Field weighed(const Field& u, const Field& v, double time_s) {
  Field w = u;
  for (std::size_t i = 0; i < u.size(); ++i) w[i] = {u[i][0] + time_s * v[i][0], u[i][1] + time_s * v[i][1]};
  return w;
}

/// Forces of the springs for displacements w: every pair of corners of every living cell, by projection.
inline Field spring_forces(const Lattice<double>& lattice, const Field& w) {
  constexpr std::array<Vector, 4> corner{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}};
  Field force(w.size());
  for (int cell = 0; cell < lattice.cells(); ++cell) {
    if (!lattice.living(cell)) continue;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        const bool side = (i - j) % 2 != 0;
        const double stiffness =
            side ? lattice.options().stiffness_n_per_m / 2.0 : lattice.options().diagonal_stiffness_n_per_m;
        const double length = side ? 1.0 : std::numbers::sqrt2;
        const Vector along{(corner[at(j)][0] - corner[at(i)][0]) / length,
                           (corner[at(j)][1] - corner[at(i)][1]) / length};
        const std::size_t a = at(lattice.node(cell, i)), b = at(lattice.node(cell, j));
        const double tension = stiffness * ((w[b][0] - w[a][0]) * along[0] + (w[b][1] - w[a][1]) * along[1]);
        for (std::size_t axis = 0; axis < 2; ++axis) {
          force[a][axis] += tension * along[axis];
          force[b][axis] -= tension * along[axis];
        }
      }
    }
  }
  return force;
}

/// Forces of springs and bedding on the nodes, with damping times in place of the lattice's own.
inline Field forces(const Lattice<double>& lattice, const Field& u, const Field& v, double spring_time,
                    double bedding_time) {
  Field force = spring_forces(lattice, weighed(u, v, spring_time));
  const Field bed = weighed(u, v, bedding_time);
  for (const int node : living_nodes(lattice)) {
    const double bedding =
        lattice.options().bedding_n_per_m * lattice.mass(node) / lattice.options().node_mass_kg;
    for (std::size_t axis = 0; axis < 2; ++axis) force[at(node)][axis] -= bedding * bed[at(node)][axis];
  }
  return force;
}

inline double dot(const Field& a, const Field& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i][0] * b[i][0] + a[i][1] * b[i][1];
  return sum;
}

template <typename Real>
double energy(const Lattice<Real>& lattice) {
  return lattice.kinetic_energy() + lattice.potential_energy();
}
/// The same, from the forces of the springs.
inline double written_out_energy(const Lattice<double>& lattice) {
  const Field u = displacements(lattice), none(u.size());
  double kinetic = 0.0;
  for (const int node : living_nodes(lattice)) {
    const Vector v = lattice.velocity(node);
    kinetic += 0.5 * lattice.mass(node) * (v[0] * v[0] + v[1] * v[1]);
  }
  return kinetic - 0.5 * dot(u, forces(lattice, u, none, 0.0, 0.0));
}

/// What no step within the limit lets grow: the energy at which leapfrog sees the lattice, less dt/4 v'Cv.
inline double discrete_energy(const Lattice<double>& lattice, double dt) {
  const Field u = displacements(lattice), v = velocities(lattice), none(u.size());
  const LatticeOptions& options = lattice.options();
  const Field elastic = forces(lattice, u, none, 0.0, 0.0);
  const Field all = forces(lattice, u, v, options.damping_time_s, options.bedding_time_s);
  return energy(lattice) + 0.5 * dt * dot(v, elastic) + 0.25 * dt * (dot(v, all) - dot(v, elastic));
}

inline Vector momentum(const Lattice<double>& lattice) {
  Vector sum{};
  for (const int node : living_nodes(lattice)) {
    const Vector v = lattice.velocity(node);
    for (std::size_t axis = 0; axis < 2; ++axis) sum[axis] += lattice.mass(node) * v[axis];
  }
  return sum;
}

inline double total_mass(const Lattice<double>& lattice) {
  double sum = 0.0;
  for (const int node : living_nodes(lattice)) sum += lattice.mass(node);
  return sum;
}

template <typename A, typename B>
double largest_difference(const Lattice<A>& lattice, const Lattice<B>& other) {
  double most = 0.0;
  const Field u = displacements(lattice), v = displacements(other);
  for (std::size_t i = 0; i < u.size(); ++i)
    most = std::max({most, std::abs(u[i][0] - v[i][0]), std::abs(u[i][1] - v[i][1])});
  return most;
}

/// Every side between two cells.
template <typename Real>
std::vector<std::pair<int, int>> sides(const Lattice<Real>& lattice) {
  std::vector<std::pair<int, int>> all;
  for (int row = 0; row < lattice.options().rows - 1; ++row) {
    for (int column = 0; column < lattice.options().columns - 1; ++column) {
      const int cell = lattice.cell(column, row);
      if (column + 2 < lattice.options().columns) all.emplace_back(cell, lattice.cell(column + 1, row));
      if (row + 2 < lattice.options().rows) all.emplace_back(cell, lattice.cell(column, row + 1));
    }
  }
  return all;
}

template <typename Real>
void cut_everything(Lattice<Real>& lattice) {
  for (const auto& [cell, neighbour] : sides(lattice)) EXPECT_TRUE(lattice.cut_side(cell, neighbour));
}

}  // namespace kerf::models

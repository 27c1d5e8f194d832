#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "stability/law_limits.h"
#include "stability/wall/wall_simulation.h"

namespace kerf::bench {

/// A grid of trials over two numbers. Cells are in rows of the second number.
struct Grid2 {
  std::vector<double> first;   ///< of the columns
  std::vector<double> second;  ///< of the rows
};

/// `count` numbers from lower to upper in equal steps of the logarithm.
[[nodiscard]] std::vector<double> logarithmic(double lower, double upper, std::size_t count);
/// In equal steps.
[[nodiscard]] std::vector<double> linear(double lower, double upper, std::size_t count);

/// What came of one cell: whether it held when it was simulated, and what the theory says of it.
struct Cell {
  bool stable = false;
  bool theory = false;
};

/// Boundaries of walls at one damping [N/m].
struct WallBoundary {
  double damping_n_s_per_m = 0.0;
  double simulated = 0.0;         ///< of the wall as it was tried
  double simulated_linear = 0.0;  ///< two-sided, without encoder steps and Coulomb friction
  double eigenvalues = 0.0;
  double colgate_schenkel = 0.0;
  double passive = 0.0;  ///< passive_stiffness()
};

/// Walls over stiffness [N/m] (columns) and damping [N·s/m] (rows) on a device.
struct WallMap {
  SampledDevice device;
  WallTrial trial;
  Grid2 grid;
  std::vector<Cell> cells;  ///< row by row; empty if only boundaries were asked for. Theory: eigenvalues
  std::vector<WallBoundary> boundaries;  ///< one a row
  double abbott_okamura = 0.0;           ///< without damping

  /// Largest difference of the simulated linear boundary to that of the eigenvalues, as a share of it, over
  /// the rows that have one within the grid.
  [[nodiscard]] double boundary_error() const;
  /// Share of the cells in which simulation and eigenvalues agree.
  [[nodiscard]] double agreement() const;
};

/// A grid that shows where walls break on a device: damping from 0 to a tenth beyond where even the softest
/// wall breaks, stiffness from a hundredth of the passive to twice the stiffest that is stable.
[[nodiscard]] Grid2 wall_grid(const SampledDevice& device, std::size_t columns, std::size_t rows);

struct MapOptions {
  bool with_cells = true;
  std::size_t threads = 1;                   ///< the result is the same for any number
  const std::atomic<bool>* stop = nullptr;   ///< ends it, without a result
  std::atomic<std::size_t>* done = nullptr;  ///< counts the rows
};

/// @throws std::system_error if it was stopped.
[[nodiscard]] WallMap wall_map(const SampledDevice& device, const WallTrial& trial, const Grid2& grid,
                               const MapOptions& options);

/// A law over depth [m] (columns, increasing) and sampling rate [Hz] (rows): passive by strokes to that and
/// every lesser depth of the grid; theory: is_locally_passive() there.
struct LawMap {
  SampledDevice device;
  double speed_m_s = 0.2;
  Grid2 grid;
  std::vector<Cell> cells;
  [[nodiscard]] double agreement() const;
};

/// Always with cells. @throws std::system_error if it was stopped.
[[nodiscard]] LawMap law_map(const SampledDevice& device, const AxisLaw& law, double speed_m_s,
                             const Grid2& grid, const MapOptions& options);

}  // namespace kerf::bench

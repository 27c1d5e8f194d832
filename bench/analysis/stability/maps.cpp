#include "stability/maps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <system_error>

#include "stability/bisection.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

bool is_stopped(const MapOptions& options) { return options.stop != nullptr && *options.stop; }

/// Calls `work(row)` for every row, on so many threads. Rows share nothing.
template <typename Work>
void for_each_row(std::size_t rows, const MapOptions& options, const Work& work) {
  for_each_index(rows, options.threads, [&](std::size_t row) {
    if (is_stopped(options)) return;
    work(row);
    if (options.done != nullptr) ++*options.done;
  });
  if (is_stopped(options))
    throw std::system_error(std::make_error_code(std::errc::interrupted), "the map is not complete");
}

double share_of_agreement(const std::vector<Cell>& cells) {
  if (cells.empty()) return 1.0;
  const auto agreeing =
      std::count_if(cells.begin(), cells.end(), [](const Cell& cell) { return cell.stable == cell.theory; });
  return static_cast<double>(agreeing) / static_cast<double>(cells.size());
}

/// How far the damping of a simulated boundary is from where the eigenvalues have it at the same stiffness,
/// as a share: where the boundary runs along the stiffness, that is what can be compared.
double damping_error(const SampledSystem& system, const WallBoundary& at) {
  const auto is_stable = [&](double damping) {
    return system.spectral_radius({at.simulated_linear, damping}) < 1.0;
  };
  double share = 1e-3;
  while (share < 1.0) {
    if (is_stable(at.damping_n_s_per_m * (1.0 - share)) != is_stable(at.damping_n_s_per_m * (1.0 + share))) {
      return share;
    }
    share *= 1.25;
  }
  return 1.0;
}

}  // namespace

std::vector<double> logarithmic(double lower, double upper, std::size_t count) {
  std::vector<double> all = linear(std::log(lower), std::log(upper), count);
  for (double& value : all) value = std::exp(value);
  return all;
}

std::vector<double> linear(double lower, double upper, std::size_t count) {
  std::vector<double> all;
  const double step = count > 1 ? (upper - lower) / static_cast<double>(count - 1) : 0.0;
  for (std::size_t i = 0; i < count; ++i) all.push_back(lower + step * static_cast<double>(i));
  return all;
}

double WallMap::boundary_error() const {
  const SampledSystem system(device);
  double most = 0.0;
  for (const WallBoundary& at : boundaries) {
    if (at.eigenvalues <= grid.first.front() || at.eigenvalues >= grid.first.back()) continue;
    const double along_stiffness = std::abs(at.simulated_linear / at.eigenvalues - 1.0);
    const double damping = at.damping_n_s_per_m;
    most = std::max(most,
                    damping > 0.0 ? std::min(along_stiffness, damping_error(system, at)) : along_stiffness);
  }
  return most;
}

Grid2 wall_grid(const SampledDevice& device, std::size_t columns, std::size_t rows) {
  constexpr double softest = 1.0;
  constexpr double stiffest = 1e7;
  const SampledSystem system(device);
  const double max_damping =
      first_change({.lower = 1e-3, .upper = 1e5, .share = 1e-2, .scan = 48}, [&](double damping) {
        return system.spectral_radius({.stiffness_n_per_m = softest, .damping_n_s_per_m = damping}) < 1.0;
      });
  const std::vector<double> dampings = linear(0.0, 1.1 * max_damping, rows);
  double max_stiffness = softest;
  for (const double damping : dampings) {
    max_stiffness = std::max(max_stiffness, eigenvalue_boundary(system, damping, softest, stiffest));
  }
  const double passive = passive_stiffness(device, 0.0);
  const double least_stiffness = std::clamp(1e-2 * passive, softest, 0.1 * max_stiffness);
  return {.first = logarithmic(least_stiffness, 2.0 * max_stiffness, columns), .second = dampings};
}

double WallMap::agreement() const { return share_of_agreement(cells); }
double LawMap::agreement() const { return share_of_agreement(cells); }

WallMap wall_map(const SampledDevice& device, const WallTrial& trial, const Grid2& grid,
                 const MapOptions& options) {
  WallMap map{.device = device, .trial = trial, .grid = grid, .abbott_okamura = abbott_okamura(device)};
  const std::size_t columns = grid.first.size();
  SampledDevice linear_device = device;
  linear_device.coulomb_n = 0.0;
  linear_device.encoder_step_m = 0.0;
  WallTrial two_sided = trial;
  two_sided.push_n = 0.0;
  const WallSimulation tried(device);
  const WallSimulation linear_walls(linear_device);
  const SampledSystem system(device);
  const PassiveWalls passive(device);
  const bool is_linear = device.is_linear() && trial.push_n == 0.0;
  map.boundaries.resize(grid.second.size());
  if (options.with_cells) map.cells.resize(columns * grid.second.size());
  for_each_row(grid.second.size(), options, [&](std::size_t row) {
    const double damping = grid.second[row];
    const double softest = grid.first.front();
    const double stiffest = grid.first.back();
    const double simulated_linear = linear_walls.boundary(damping, softest, stiffest, two_sided);
    map.boundaries[row] = {
        .damping_n_s_per_m = damping,
        .simulated = is_linear ? simulated_linear : tried.boundary(damping, softest, stiffest, trial),
        .simulated_linear = simulated_linear,
        .eigenvalues = eigenvalue_boundary(system, damping, softest, stiffest),
        .colgate_schenkel = colgate_schenkel(device, damping),
        .passive = passive.stiffness(damping)};
    if (!options.with_cells) return;
    std::vector<Wall> walls;
    for (const double stiffness : grid.first) walls.push_back({stiffness, damping});
    const std::vector<bool> rest = tried.come_to_rest(walls, trial);
    for (std::size_t column = 0; column < columns; ++column) {
      map.cells[row * columns + column] = {.stable = rest[column],
                                           .theory = system.spectral_radius(walls[column]) < 1.0};
    }
  });
  return map;
}

LawMap law_map(const SampledDevice& device, const AxisLaw& law, double speed_m_s, const Grid2& grid,
               const MapOptions& options) {
  LawMap map{.device = device, .speed_m_s = speed_m_s, .grid = grid};
  const std::size_t columns = grid.first.size();
  map.cells.resize(columns * grid.second.size());
  for_each_row(grid.second.size(), options, [&](std::size_t row) {
    SampledDevice at = device;
    at.period_s = 1.0 / grid.second[row];
    Cell so_far{.stable = true, .theory = true};  // what fails at a depth fails beyond it
    for (std::size_t column = 0; column < columns; ++column) {
      const ToolRange range{.depth_m = grid.first[column], .speed_m_s = speed_m_s};
      so_far.stable = so_far.stable && is_passive_at(at, law, range);
      so_far.theory = so_far.theory && is_locally_passive(at, law, range);
      map.cells[row * columns + column] = so_far;
    }
  });
  return map;
}

}  // namespace kerf::bench

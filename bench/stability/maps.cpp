#include "stability/maps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace kerf::bench {
namespace {

/// Calls `work(row)` for every row, on so many threads. Rows share nothing.
template <typename Work>
void for_each_row(std::size_t rows, std::size_t threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t row = next++; row < rows; row = next++) work(row);
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < std::min(threads, rows); ++i) others.emplace_back(run);
  run();
}

double share_of_agreement(const std::vector<Cell>& cells) {
  if (cells.empty()) return 1.0;
  const auto agreeing =
      std::count_if(cells.begin(), cells.end(), [](const Cell& cell) { return cell.stable == cell.theory; });
  return static_cast<double>(agreeing) / static_cast<double>(cells.size());
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

double WallMap::agreement() const { return share_of_agreement(cells); }
double LawMap::agreement() const { return share_of_agreement(cells); }

WallMap wall_map(const SampledDevice& device, const WallTrial& trial, const Grid2& grid,
                 const MapOptions& options) {
  WallMap map{.device = device, .trial = trial, .grid = grid, .abbott_okamura = abbott_okamura(device)};
  const std::size_t columns = grid.first.size();
  map.boundaries.resize(grid.second.size());
  if (options.with_cells) map.cells.resize(columns * grid.second.size());
  for_each_row(grid.second.size(), options.threads, [&](std::size_t row) {
    const double damping = grid.second[row];
    const double softest = grid.first.front();
    const double stiffest = grid.first.back();
    map.boundaries[row] = {.damping_n_s_per_m = damping,
                           .simulated = simulated_boundary(device, damping, softest, stiffest, trial),
                           .eigenvalues = eigenvalue_boundary(device, damping, softest, stiffest),
                           .colgate_schenkel = colgate_schenkel(device, damping),
                           .passive = passive_stiffness(device, damping)};
    if (!options.with_cells) return;
    for (std::size_t column = 0; column < columns; ++column) {
      const Wall wall{.stiffness_n_per_m = grid.first[column], .damping_n_s_per_m = damping};
      map.cells[row * columns + column] = {.stable = comes_to_rest(device, wall, trial),
                                           .theory = spectral_radius(device, wall) < 1.0};
    }
  });
  return map;
}

LawMap law_map(const SampledDevice& device, const AxisLaw& law, double speed_m_s, const Grid2& grid,
               std::size_t threads) {
  LawMap map{.device = device, .speed_m_s = speed_m_s, .grid = grid};
  const std::size_t columns = grid.first.size();
  map.cells.resize(columns * grid.second.size());
  for_each_row(grid.second.size(), threads, [&](std::size_t row) {
    SampledDevice at = device;
    at.period_s = 1.0 / grid.second[row];
    const double limit = passive_stiffness_up_to(at, speed_m_s);
    for (std::size_t column = 0; column < columns; ++column) {
      const double depth_m = grid.first[column];
      map.cells[row * columns + column] = {.stable = is_passive(at, law, {depth_m, speed_m_s}),
                                           .theory = local_stiffness(law, depth_m, at.period_s) <= limit};
    }
  });
  return map;
}

}  // namespace kerf::bench

#include "modulated.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace kerf::identification {
namespace {

constexpr std::size_t direction_ticks = 4;

}  // namespace

std::vector<Window> windows_of(const AxisData& data, std::span<const Stretch> stretches) {
  std::vector<Window> windows;
  std::size_t first_cluster = 0;
  for (const Stretch& stretch : stretches) {
    for (std::size_t begin = std::max<std::size_t>(stretch.begin, 16); begin + window <= stretch.end();
         begin += half_window) {
      bool whole = true;
      for (std::size_t n = begin; n < begin + window; ++n) whole &= std::isfinite(data.position_m[n]);
      const std::size_t part = (begin - stretch.begin) % stretch.period * parts_of_a_period / stretch.period;
      if (whole) windows.push_back({begin, stretch.place, first_cluster + part});
    }
    first_cluster += parts_of_a_period;
  }
  return windows;
}

Signals::Signals(const AxisData& data) : data_(data), direction_(data.position_m.size(), 0.0) {
  for (std::size_t n = direction_ticks; n + direction_ticks < direction_.size(); ++n) {
    const double moved = data.position_m[n + direction_ticks] - data.position_m[n - direction_ticks];
    direction_[n] = moved > 0.0 ? 1.0 : (moved < 0.0 ? -1.0 : 0.0);
  }
}

Signals::Signals(const AxisData& data, const OutputErrorFit& fit)
    : data_(data), direction_(data.position_m.size(), 0.0) {
  const double f = fit.model.axis.coulomb_n;
  for (std::size_t n = 1; n < direction_.size(); ++n) {
    // Means over a tick: that of the two around a reading has the same place among the weights as the
    // reading.
    const double both = 0.5 * (fit.friction[n - 1].mean_n + fit.friction[n].mean_n);
    direction_[n] = f > 0.0 ? -both / f : 0.0;
  }
}

LeastSquares least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& right) {
  const Eigen::VectorXd scale = columns.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = columns * scale.asDiagonal();
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() *
      Eigen::MatrixXd((scaled.transpose() * scaled)
                          .ldlt()
                          .solve(Eigen::MatrixXd::Identity(columns.cols(), columns.cols()))) *
      scale.asDiagonal();
  const Eigen::VectorXd solution = inverse * (columns.transpose() * right);
  return {.solution = solution, .residual = right - columns * solution, .inverse = inverse};
}

Eigen::MatrixXd columns_of(const AxisData& data, const Signals& signals, std::span<const Window> windows,
                           std::size_t places) {
  const Modulating w(data.period_s);
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(windows.size()), static_cast<Eigen::Index>(4 + places));
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const std::size_t begin = windows[i].begin;
    const auto row = static_cast<Eigen::Index>(i);
    const double at = signals.position(begin + half_window);
    const auto position = [&](std::size_t n) { return signals.position(n) - at; };
    columns(row, 0) = product(w.second, begin, position);
    columns(row, 1) = -product(w.first, begin, position);
    columns(row, 2) = product(w.value, begin, [&](std::size_t n) { return signals.position(n); });
    columns(row, 3) = product(w.value, begin, [&](std::size_t n) { return signals.direction(n); });
    columns(row, static_cast<Eigen::Index>(4 + windows[i].place)) =
        -product(w.value, begin, [](std::size_t) { return 1.0; });
  }
  return columns;
}

Eigen::VectorXd forces_of(const AxisData& data, const Signals& signals, std::span<const Window> windows,
                          double delay_ticks) {
  const Modulating w(data.period_s);
  Eigen::VectorXd forces(static_cast<Eigen::Index>(windows.size()));
  for (std::size_t i = 0; i < windows.size(); ++i) {
    forces[static_cast<Eigen::Index>(i)] =
        product(w.value, windows[i].begin, [&](std::size_t n) { return signals.delayed(n, delay_ticks); });
  }
  return forces;
}

}  // namespace kerf::identification

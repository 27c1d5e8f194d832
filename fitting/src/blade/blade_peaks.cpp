#include "blade/blade_peaks.h"

#include <algorithm>
#include <cmath>

#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

/// A line through `count` rows at a uniform distance that ends half a row beyond the nearest one.
struct Line {
  Vector6d end = Vector6d::Zero();
  Vector6d variance = Vector6d::Zero();  ///< of the residuals
};

/// Variance of the end of a line, per variance of its rows.
double end_variance(std::size_t count) {
  const auto n = static_cast<double>(count);
  return 1.0 / n + 3.0 * n / ((n - 1.0) * (n + 1.0));
}

template <typename RowAt>
Line line_through(const BladeRows& rows, std::size_t count, RowAt row_at) {
  const auto n = static_cast<double>(count);
  const double middle = 0.5 * (n - 1.0);
  Vector6d mean = Vector6d::Zero();
  Vector6d moment = Vector6d::Zero();
  for (std::size_t j = 0; j < count; ++j) {
    const Vector6d& force = rows.force[row_at(j)];
    mean += force / n;
    moment += (static_cast<double>(j) - middle) * force;
  }
  const Vector6d slope = moment / (n * (n * n - 1.0) / 12.0);
  Line line{.end = mean - (middle + 0.5) * slope};
  for (std::size_t j = 0; j < count; ++j) {
    line.variance += (rows.force[row_at(j)] - mean - (static_cast<double>(j) - middle) * slope).cwiseAbs2();
  }
  line.variance /= n - 2.0;
  return line;
}

struct Candidate {
  Jump jump;
  double size = 0.0;  ///< in standard errors
};

Candidate candidate_at(const BladeRows& rows, std::size_t row, std::size_t window, const Vector6d& noise) {
  const Line before = line_through(rows, window, [&](std::size_t j) { return row - 1 - j; });
  const Line after = line_through(rows, window, [&](std::size_t j) { return row + j; });
  const Vector6d variance =
      noise.cwiseAbs2().cwiseMax(before.variance).cwiseMax(after.variance) * end_variance(window);
  const Vector6d difference = after.end - before.end;
  return {.jump = {.row = row,
                   .before = before.end,
                   .after = after.end,
                   .error_n = std::sqrt(variance.head<3>().maxCoeff())},
          .size = std::sqrt((difference.cwiseAbs2().array() / (2.0 * variance.array())).sum())};
}

}  // namespace

std::size_t window_rows(const BladeRows& rows, const BladeFitOptions& options) {
  const double count = options.peaks.window_s / rows.period_s;
  return std::max<std::size_t>(5, static_cast<std::size_t>(std::lround(std::min(count, 1e4))));
}

Vector6d noise_of(const BladeRows& rows, const BladeFitOptions& options) {
  Vector6d noise = Vector6d::Zero();
  std::vector<double> sizes;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    sizes.clear();
    double largest = 0.0;
    for (std::size_t i = 3; i < rows.size(); ++i) {
      const auto force = [&](std::size_t k) { return rows.force[k][axis]; };
      if (!rows.in_tissue[i - 3] || !rows.in_tissue[i]) continue;
      sizes.push_back(std::abs(force(i) - 3.0 * force(i - 1) + 3.0 * force(i - 2) - force(i - 3)));
      largest = std::max(largest, rows.force[i].segment<3>(axis < 3 ? 0 : 3).norm());
    }
    if (sizes.empty()) continue;
    // 20 = 1 + 9 + 9 + 1; and no force is known better than to a thousandth.
    noise[axis] = std::max(robust_deviation(sizes) / std::sqrt(20.0), 1e-3 * largest);
  }
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double given = options.noise[static_cast<std::size_t>(axis)];
    if (given > 0.0) noise[axis] = given;
    if (!(noise[axis] > 0.0)) noise[axis] = 1.0;  // no force at all
  }
  return noise;
}

std::vector<Jump> find_jumps(const BladeRows& rows, const Vector6d& noise, const BladeFitOptions& options) {
  const std::size_t window = window_rows(rows, options);
  std::vector<Candidate> found;
  std::size_t whole = 0;  // rows up to here that follow each other in the tissue
  for (std::size_t i = 0; i < rows.size(); ++i) {
    whole = rows.in_tissue[i] ? (rows.follows(i) ? whole + 1 : 1) : 0;
    if (whole < 2 * window) continue;
    Candidate candidate = candidate_at(rows, i + 1 - window, window, noise);
    if (candidate.size < options.peaks.prominence) continue;
    if (found.empty() || candidate.jump.row - found.back().jump.row >= window) {
      found.push_back(std::move(candidate));
    } else if (candidate.size > found.back().size) {
      found.back() = std::move(candidate);
    }
  }
  std::vector<Jump> jumps;
  for (const Candidate& candidate : found) jumps.push_back(candidate.jump);
  return jumps;
}

}  // namespace kerf::fitting

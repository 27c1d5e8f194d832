#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include <kerf/fitting/segmented.h>

namespace kerf::test {

/// Points of a curve that own themselves.
struct CurvePoints {
  std::vector<double> x, y, weight;
  std::vector<std::uint8_t> branch;

  [[nodiscard]] fitting::Curve curve() const {
    return {.position = x, .force = y, .weight = weight, .branch = branch};
  }
};

inline double interpolate(const std::vector<double>& knots, const std::vector<double>& force, double x) {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, x) - knots.begin();
  const auto i = static_cast<std::size_t>(above - 1);
  return force[i] + (force[i + 1] - force[i]) * (x - knots[i]) / (knots[i + 1] - knots[i]);
}

/// Evenly spread points of any function, with noise; on two branches the second is -0.4 of it, plus x.
template <typename Function>
CurvePoints sampled(std::size_t count, double noise, unsigned seed, bool loop, const Function& function) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  CurvePoints points;
  const std::uint8_t branches = loop ? 2 : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(count - 1);
    for (std::uint8_t branch = 0; branch < branches; ++branch) {
      points.x.push_back(x);
      points.y.push_back((branch == 1 ? x - 0.4 * function(x) : function(x)) + noise * normal(random));
      if (loop) points.branch.push_back(branch);
    }
  }
  return points;
}

/// The least sum of squares at given knots by dense least squares, without any of the product's code;
/// infinite if a segment has too few points.
inline double dense_error(const CurvePoints& points, const std::vector<double>& knots, std::size_t fewest) {
  double total = 0.0;
  const std::uint8_t branches = points.branch.empty() ? 1 : 2;
  for (std::uint8_t branch = 0; branch < branches; ++branch) {
    const auto size = static_cast<Eigen::Index>(points.x.size());
    const auto columns = static_cast<Eigen::Index>(knots.size());
    Eigen::MatrixXd hats = Eigen::MatrixXd::Zero(size, columns);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(size);
    std::vector<std::size_t> in_segment(knots.size() - 1, 0);
    for (Eigen::Index row = 0; row < size; ++row) {
      const auto i = static_cast<std::size_t>(row);
      if (!points.branch.empty() && points.branch[i] != branch) continue;
      const double weight = points.weight.empty() ? 1.0 : points.weight[i];
      if (weight == 0.0) continue;
      const auto segment =
          std::upper_bound(knots.begin() + 1, knots.end() - 1, points.x[i]) - knots.begin() - 1;
      const auto s = static_cast<std::size_t>(segment);
      ++in_segment[s];
      if (s > 0 && points.x[i] == knots[s]) ++in_segment[s - 1];
      const double share = (points.x[i] - knots[s]) / (knots[s + 1] - knots[s]);
      hats(row, segment) = std::sqrt(weight) * (1.0 - share);
      hats(row, segment + 1) = std::sqrt(weight) * share;
      force[row] = std::sqrt(weight) * points.y[i];
    }
    if (*std::min_element(in_segment.begin(), in_segment.end()) < fewest) {
      return std::numeric_limits<double>::infinity();
    }
    total += (force - hats * hats.completeOrthogonalDecomposition().solve(force)).squaredNorm();
  }
  return total;
}

/// What a rival reaches that knows nothing of grids: differential evolution over the inner knots, its best
/// then improved by ever smaller random steps.
inline double evolved_error(const CurvePoints& points, std::size_t segments, std::size_t fewest) {
  struct Member {
    std::vector<double> knots;
    double error;
  };
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto valued = [&](std::vector<double> inner) {
    std::sort(inner.begin(), inner.end());
    std::vector<double> knots{0.0};
    knots.insert(knots.end(), inner.begin(), inner.end());
    knots.push_back(1.0);
    const bool apart = std::adjacent_find(knots.begin(), knots.end(),
                                          [](double a, double b) { return b - a < 1e-9; }) == knots.end();
    return Member{inner,
                  apart ? dense_error(points, knots, fewest) : std::numeric_limits<double>::infinity()};
  };
  std::vector<Member> members;
  while (members.size() < 10 * (segments - 1)) {
    std::vector<double> inner(segments - 1);
    for (double& knot : inner) knot = uniform(random);
    members.push_back(valued(inner));
  }
  std::uniform_int_distribution<std::size_t> anyone(0, members.size() - 1);
  const auto lower = [](const Member& a, const Member& b) { return a.error < b.error; };
  for (int generation = 0; generation < 60; ++generation) {
    for (Member& member : members) {
      const auto& best = std::min_element(members.begin(), members.end(), lower)->knots;
      const auto &one = members[anyone(random)].knots, &other = members[anyone(random)].knots;
      auto trial = member.knots;
      for (std::size_t i = 0; i < trial.size(); ++i) {
        if (uniform(random) < 0.7) trial[i] = std::clamp(best[i] + 0.7 * (one[i] - other[i]), 0.0, 1.0);
      }
      if (Member next = valued(trial); next.error < member.error) member = std::move(next);
    }
  }
  Member best = *std::min_element(members.begin(), members.end(), lower);
  for (double reach = 0.01; reach > 1e-7; reach *= 0.98) {
    auto trial = best.knots;
    for (double& knot : trial) knot = std::clamp(knot + reach * (uniform(random) - 0.5), 0.0, 1.0);
    if (Member next = valued(trial); next.error < best.error) best = std::move(next);
  }
  return best.error;
}

/// The same for the best of all choices of inner knots on a grid.
inline double exhaustive_error(const CurvePoints& points, std::size_t cells, std::size_t segments,
                               std::size_t fewest) {
  const auto [first, last] = std::minmax_element(points.x.begin(), points.x.end());
  double best = std::numeric_limits<double>::infinity();
  std::vector<bool> chosen(cells - 1, false);
  std::fill_n(chosen.begin(), segments - 1, true);
  do {
    std::vector<double> knots{*first};
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (chosen[i]) {
        knots.push_back(*first + (*last - *first) * static_cast<double>(i + 1) / static_cast<double>(cells));
      }
    }
    knots.push_back(*last);
    best = std::min(best, dense_error(points, knots, fewest));
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return best;
}

}  // namespace kerf::test

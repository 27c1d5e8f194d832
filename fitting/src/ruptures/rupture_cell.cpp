#include "ruptures/rupture_cell.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "infinite.h"

namespace kerf::fitting {

RuptureParts::RuptureParts(const BreakingSamples& data, const RuptureRows& rows) {
  const Samples& all = data.samples;
  element.parameters = models::Law::parameters(element.model);
  element.free.assign(element.parameters.size(), true);
  element.own.assign(element.parameters.size(), false);
  samples.least = all.least;
  samples.most = all.most;
  samples.fastest = all.fastest;
  samples.median_period_s = all.median_period_s;
  samples.duration_s = all.duration_s;
  const auto take = [&](std::size_t i, double reference, double weight) {
    samples.motion.push_back({all.motion[i].penetration - reference, all.motion[i].velocity});
    samples.period_s.push_back(all.period_s[i]);
    samples.force.push_back(all.force[i]);
    weights.push_back(weight);
    points.speed.push_back(data.speed[i]);
  };
  auto next = rows.begin();
  for (const Run& run : all.runs) {
    double reference = 0.0;
    std::size_t begin = 0;
    const auto end_part = [&] {
      samples.runs.push_back({.begin = begin,
                              .end = samples.motion.size(),
                              .noise_n = run.noise_n,
                              .contact_error = reference == 0.0 ? run.contact_error : 0.0});
      begin = samples.motion.size();
    };
    begin = samples.motion.size();
    for (std::size_t i = run.begin; i < run.end; ++i) {
      if (next != rows.end() && *next == i) {
        if (data.weights[i] > 0.0) points.ruptured.push_back(samples.motion.size());
        take(i, reference, 0.0);
        end_part();
        reference = all.motion[i].penetration;
        ++next;
      } else if (data.weights[i] > 0.0) {
        points.whole.push_back(samples.motion.size());
      }
      take(i, reference, data.weights[i]);
    }
    end_part();
  }
  element.runs = samples.runs.size();
  samples.counts.assign(samples.size(), 1);
  samples.cycle.assign(samples.size(), 0);
  samples.fold.assign(samples.size(), Samples::no_fold);
}

ElementValues InCell::element() const { return {std::exp(at[0]), std::exp(at[1]), std::exp(at[2])}; }

namespace {

/// Straight cuts of the condition, the last few that were met.
struct Cuts {
  std::vector<Separation> of;

  void take(const Separation& separation) {
    constexpr std::size_t most = 16;
    if (of.size() == most) of.erase(of.begin());
    of.push_back(separation);
  }
};

/// d of least 1/2 d'Hd + g'd, with a price for each cut value + row d that falls below zero: by its dual, one
/// cut after another.
Eigen::VectorXd step_under(const Eigen::MatrixXd& normal, const Eigen::VectorXd& score,
                           const Eigen::MatrixXd& rows, const Eigen::VectorXd& values, double price) {
  constexpr int most_rounds = 200;
  Eigen::VectorXd step = solve_normal(normal, -score);
  const Eigen::Index count = values.size();
  Eigen::MatrixXd moved(score.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) moved.col(k) = solve_normal(normal, rows.row(k).transpose());
  Eigen::VectorXd pressed = Eigen::VectorXd::Zero(count);
  for (int round = 0; round < most_rounds; ++round) {
    double most = 0.0;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double stiffness = rows.row(k).dot(moved.col(k));
      if (!(stiffness > 0.0)) continue;
      const double next =
          std::clamp(pressed[k] - (values[k] + rows.row(k).dot(step)) / stiffness, 0.0, price);
      step += (next - pressed[k]) * moved.col(k);
      most = std::max(most, std::abs(next - pressed[k]));
      pressed[k] = next;
    }
    if (most <= 1e-12 * price) break;
  }
  return step;
}

}  // namespace

struct RuptureCell::Point {
  Eigen::VectorXd at;
  Eigen::VectorXd force;
  Eigen::MatrixXd jacobian;
  Sums sums;
  Separation separation;
};

RuptureCell::RuptureCell(const RuptureParts& parts, const RobustLoss& loss)
    : parts_(parts),
      loss_(loss),
      all_(parts.samples.size(), 1.0),
      objective_(parts.element, parts.samples, all_,
                 Values(parts.samples.runs.size(), std::vector<double>(3, 1.0))),
      largest_(0.0) {
  for (const double force : parts.samples.force) largest_ = std::max(largest_, std::abs(force));
}

Sums RuptureCell::sums_of(const Point& point) const {
  const double* const columns[] = {point.jacobian.col(0).data(), point.jacobian.col(1).data(),
                                   point.jacobian.col(2).data()};
  double squares = 0.0;
  std::array<double, 3> score{};
  std::array<double, 6> normal{};
  for (std::size_t i = 0; i < parts_.weights.size(); ++i) {
    if (parts_.weights[i] == 0.0) continue;
    const double residual = point.force[static_cast<Eigen::Index>(i)] - parts_.samples.force[i];
    double weight = parts_.weights[i];
    if (loss_.kind == Loss::squares) {
      squares += weight * residual * residual;
    } else {
      const auto [rho, slope] = loss_(weight * residual * residual);
      squares += rho;
      weight *= slope;
    }
    const double row[] = {columns[0][i], columns[1][i], columns[2][i]};
    for (std::size_t a = 0, place = 0; a < 3; ++a) {
      score[a] += weight * row[a] * residual;
      for (std::size_t b = 0; b <= a; ++b, ++place) normal[place] += weight * row[a] * row[b];
    }
  }
  Sums sums{.squares = squares,
            .score = Eigen::Vector3d(score[0], score[1], score[2]),
            .normal = Eigen::Matrix3d::Zero()};
  for (Eigen::Index a = 0, place = 0; a < 3; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b, ++place)
      sums.normal(a, b) = sums.normal(b, a) = normal[static_cast<std::size_t>(place)];
  }
  return sums;
}

RupturePoints RuptureCell::points_near(const Eigen::VectorXd& force) const {
  constexpr double far_below = 0.3;  // of the least force that ruptured: no line comes there
  double least = infinite;
  for (const std::size_t i : parts_.points.ruptured)
    least = std::min(least, force[static_cast<Eigen::Index>(i)]);
  RupturePoints near{.speed = parts_.points.speed, .ruptured = parts_.points.ruptured, .whole = {}};
  for (const std::size_t i : parts_.points.whole) {
    if (force[static_cast<Eigen::Index>(i)] > far_below * least) near.whole.push_back(i);
  }
  near.sort_whole();
  return near;
}

bool RuptureCell::look(const Eigen::VectorXd& at, const RupturePoints& points, const HeldLine& held,
                       Point& point) const {
  if (!at.allFinite() || !objective_.rows(at, point.force, point.jacobian) || !point.force.allFinite())
    return false;
  point.at = at;
  point.sums = sums_of(point);
  if (!point.sums.normal.allFinite()) return false;
  if (points.ruptured.empty()) {
    point.separation.margin = infinite;
  } else {
    point.separation = separation_of(points, point.force, held);
  }
  return true;
}

InCell RuptureCell::descend(const Eigen::VectorXd& start, const HeldLine& held, bool free,
                            double tolerance) const {
  constexpr int most_steps = 40;
  constexpr int enough = 2;
  constexpr double longest = 1.5;  // step of a logarithm
  constexpr double within = 1e-7;  // of the largest force, by which the rows rupture
  constexpr double dear = 300.0;   // times the largest force a newton short: more than a rupture elsewhere
  const double least = within * largest_;
  const double price = free ? 0.0 : dear * largest_;
  const auto cost = [&](const Point& point) {
    return 0.5 * point.sums.squares + price * std::max(0.0, least - point.separation.margin);
  };
  const Bounds bounds = parts_.element.bounds();
  Point here;
  Point there;
  Cuts cuts;
  const Eigen::VectorXd begin = start.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  Eigen::VectorXd force;
  Eigen::MatrixXd jacobian;
  if (!objective_.rows(begin, force, jacobian)) return {.at = start, .squares = infinite};
  const RupturePoints points = points_near(force);
  if (!look(begin, points, held, here)) return {.at = start, .squares = infinite};
  cuts.take(here.separation);
  double damping = 1e-4;
  int small_gains = 0;
  for (int step = 0; step < most_steps && small_gains < enough; ++step) {
    const auto count = static_cast<Eigen::Index>(free ? 0 : cuts.of.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, here.at.size());
    Eigen::VectorXd values(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Separation& cut = cuts.of[static_cast<std::size_t>(k)];
      values[k] = cut.constant - least;
      for (const auto& [at, weight] : cut.points) {
        values[k] += weight * here.force[static_cast<Eigen::Index>(at)];
        rows.row(k) += weight * here.jacobian.row(static_cast<Eigen::Index>(at));
      }
    }
    Eigen::MatrixXd normal = here.sums.normal;
    normal.diagonal() += damping * normal.diagonal() +
                         Eigen::VectorXd::Constant(normal.cols(), 1e-12 * normal.diagonal().maxCoeff());
    Eigen::VectorXd way = step_under(normal, here.sums.score, rows, values, price);
    way *= std::min(1.0, longest / std::max(1e-300, way.cwiseAbs().maxCoeff()));
    const Eigen::VectorXd at = (here.at + way).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
    if (!look(at, points, held, there)) {
      damping = std::max(1e-3, 10.0 * damping);
      if (damping > 1e6) break;
      continue;
    }
    const double gain = cost(here) - cost(there);
    if (there.separation.margin < least) cuts.take(there.separation);
    if (!(gain > 0.0)) {
      if (std::abs(gain) <= tolerance * cost(here)) break;
      damping = std::max(1e-3, 10.0 * damping);
      if (damping > 1e6) break;
      continue;
    }
    small_gains = gain <= tolerance * cost(here) ? small_gains + 1 : 0;
    damping *= 0.2;
    std::swap(here, there);
  }
  return {.at = here.at, .squares = here.sums.squares, .separation = here.separation};
}

}  // namespace kerf::fitting

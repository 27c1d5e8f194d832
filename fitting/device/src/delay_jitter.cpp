#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <boost/math/distributions/students_t.hpp>

#include <kerf/identification/delay_jitter.h>

namespace kerf::identification {
namespace {

constexpr std::size_t shot_ticks = 48;
constexpr std::size_t block_ticks = 2;  // means over them are read as well, and cost an eighth
constexpr std::size_t least_sliding_shots = 24;
constexpr Eigen::Index components = 3;
constexpr Eigen::Index jitter = 1;
constexpr int rounds = 8;

using Components = Eigen::Matrix<double, components, 1>;
using Square = Eigen::Matrix<double, components, components>;

/// Ways over a shot of a motion without friction from a unit of position, and from a unit of speed.
Eigen::MatrixXd free_ways(const AxisModel& model, double period_s, std::size_t count) {
  const Transition tick = transition_over(model, period_s);
  Eigen::MatrixXd ways(static_cast<Eigen::Index>(count), 2);
  Motion from_position{.position_m = 1.0, .speed_m_s = 0.0};
  Motion from_speed{.position_m = 0.0, .speed_m_s = 1.0};
  for (Eigen::Index i = 0; i < ways.rows(); ++i) {
    ways.row(i) << from_position.position_m, from_speed.position_m;
    from_position = tick.step(from_position, 0.0);
    from_speed = tick.step(from_speed, 0.0);
  }
  return ways;
}

bool slides_one_way(std::span<const TickFriction> friction, double coulomb_n) {
  if (coulomb_n <= 0.0) return true;
  const double first_n = friction.front().mean_n;
  return std::ranges::all_of(
             friction,
             [&](const TickFriction& tick) { return std::abs(tick.mean_n - first_n) < 1e-6 * coulomb_n; }) &&
         std::abs(std::abs(first_n) - coulomb_n) < 1e-6 * coulomb_n;
}

/// How readings of a shot, by blocks and without what a free begin explains, follow a unit of noise of each
/// reading, and a unit of speed that came during each tick.
struct Seen {
  Eigen::MatrixXd of_readings;
  Eigen::MatrixXd of_speeds;
};
Seen seen_of(const AxisModel& model, double period_s) {
  const auto ticks = static_cast<Eigen::Index>(shot_ticks);
  const auto block = static_cast<Eigen::Index>(block_ticks);
  const Eigen::MatrixXd ways = free_ways(model, period_s, shot_ticks);
  // A force that comes a part of a tick late leads to a motion that much later.
  const double late = model.delay_s / period_s - std::floor(model.delay_s / period_s);
  Eigen::MatrixXd way_of = Eigen::MatrixXd::Zero(ticks, ticks);
  for (Eigen::Index j = 0; j < ticks; ++j) {
    way_of.col(j).tail(ticks - j) += (1.0 - late) * ways.col(1).head(ticks - j);
    way_of.col(j).tail(ticks - j - 1) += late * ways.col(1).head(ticks - j - 1);
  }
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(ticks / block, ticks);
  for (Eigen::Index i = 0; i < means.rows(); ++i) {
    means.row(i).segment(i * block, block).setConstant(1.0 / static_cast<double>(block));
  }
  const Eigen::MatrixXd begin = means * ways;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(begin);
  const Eigen::MatrixXd all = qr.householderQ() * Eigen::MatrixXd::Identity(means.rows(), means.rows());
  const Eigen::MatrixXd seen = all.rightCols(means.rows() - 2).transpose() * means;
  return {.of_readings = seen, .of_speeds = seen * way_of};
}

/// What one shot left, and what variances of one of the three kinds would leave in it.
struct Left {
  Eigen::VectorXd read;
  std::array<Eigen::MatrixXd, components> variance;
  std::size_t cluster = 0;
};

std::vector<Left> left_of(const AxisData& data, std::span<const Shot> shots, const PlacedModel& model) {
  const OutputErrorFit fit = predict(data, shots, model);
  const Seen seen = seen_of(model.axis, data.period_s);
  const double mass = model.axis.mass_kg;
  const auto delay_ticks = static_cast<std::size_t>(model.axis.delay_s / data.period_s);
  const Eigen::MatrixXd of_noise = seen.of_readings * seen.of_readings.transpose();
  const double per_force = data.period_s / mass;
  const Eigen::MatrixXd of_force = per_force * per_force * seen.of_speeds * seen.of_speeds.transpose();
  std::vector<Left> out;
  for (const Shot& shot : shots) {
    const auto friction = std::span(fit.friction).subspan(shot.begin, shot.count);
    if (!slides_one_way(friction, model.axis.coulomb_n)) continue;
    Eigen::VectorXd residual(static_cast<Eigen::Index>(shot.count));
    Eigen::VectorXd speeds(residual.size());
    for (std::size_t i = 0; i < shot.count; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const std::size_t at = shot.begin + i;
      residual[row] = fit.residual_m[at];
      speeds[row] = at > delay_ticks
                        ? (data.commanded_n[at - delay_ticks] - data.commanded_n[at - delay_ticks - 1]) / mass
                        : 0.0;
    }
    if (!residual.allFinite()) continue;
    const Eigen::MatrixXd changed = seen.of_speeds * speeds.asDiagonal();
    out.push_back({.read = seen.of_readings * residual,
                   .variance = {of_noise, changed * changed.transpose(), of_force},
                   .cluster = shot.cluster});
  }
  return out;
}

struct Estimated {
  Components variance;
  Square covariance;
};

/// Fisher's scoring of the restricted likelihood [PattersonThompson1971]; the covariance by the scores of the
/// clusters.
Estimated estimated(const std::vector<Left>& shots, std::size_t clusters) {
  Components size = Components::Zero();  // what each alone would have to be
  for (const Left& shot : shots) {
    for (std::size_t i = 0; i < components; ++i) {
      size[static_cast<Eigen::Index>(i)] += shot.read.squaredNorm() / shot.variance[i].trace();
    }
  }
  size = (size / static_cast<double>(shots.size())).cwiseMax(1e-300);
  Components variance{1.0, 0.0, 0.0};
  Square inverse;
  Square between;
  for (int round = 0; round < rounds; ++round) {
    const Components taken = variance.cwiseMax(Components{1e-2, 0.0, 0.0});
    Square information = Square::Zero();
    std::vector<std::pair<std::size_t, std::pair<Components, Square>>> scores;
    Components right = Components::Zero();
    for (const Left& shot : shots) {
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(shot.read.size(), shot.read.size());
      for (std::size_t i = 0; i < components; ++i) {
        const auto index = static_cast<Eigen::Index>(i);
        sum += taken[index] * size[index] * shot.variance[i];
      }
      const Eigen::LLT<Eigen::MatrixXd> root(sum);
      const Eigen::VectorXd weighed = root.solve(shot.read);
      std::array<Eigen::MatrixXd, components> share;
      Components squares;
      for (std::size_t i = 0; i < components; ++i) {
        const auto index = static_cast<Eigen::Index>(i);
        share[i] = size[index] * root.solve(shot.variance[i]);
        squares[index] = size[index] * weighed.dot(shot.variance[i] * weighed);
      }
      Square traces;
      for (std::size_t i = 0; i < components; ++i) {
        for (std::size_t j = 0; j < components; ++j) {
          traces(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
              share[i].cwiseProduct(share[j].transpose()).sum();
        }
      }
      information += traces;
      right += squares;
      scores.push_back({shot.cluster, {squares, traces}});
    }
    inverse = information.ldlt().solve(Square::Identity());
    variance = inverse * right;
    std::map<std::size_t, Components> by_cluster;
    for (const auto& [cluster, score] : scores) {
      by_cluster.try_emplace(cluster, Components::Zero()).first->second +=
          score.first - score.second * variance;
    }
    between.setZero();
    for (const auto& [cluster, score] : by_cluster) between += score * score.transpose();
  }
  const auto n = static_cast<double>(clusters);
  const double degrees = n / std::max(1.0, n - static_cast<double>(components));
  return {.variance = size.cwiseProduct(variance),
          .covariance = degrees * size.asDiagonal() * inverse * between * inverse * size.asDiagonal()};
}

}  // namespace

std::optional<DelayJitter> delay_jitter(const AxisData& data, std::span<const Stretch> stretches,
                                        const PlacedModel& model) {
  std::vector<Shot> shots;
  std::size_t clusters = 0;
  for (const Stretch& stretch : stretches) {
    const std::size_t parts = stretch.period / shot_ticks;
    for (std::size_t period = 0; period < stretch.periods; ++period) {
      for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t begin = stretch.begin + period * stretch.period + part * shot_ticks;
        if (begin < 64) continue;
        shots.push_back(
            {.begin = begin, .count = shot_ticks, .cluster = clusters + part, .place = stretch.place});
      }
    }
    clusters += parts;
  }
  const std::vector<Left> left = left_of(data, shots, model);
  if (left.size() < least_sliding_shots) return std::nullopt;
  std::map<std::size_t, std::size_t> shots_of_cluster;
  double squares = 0.0;
  for (const Left& shot : left) {
    ++shots_of_cluster[shot.cluster];
    squares += shot.read.squaredNorm();
  }
  if (shots_of_cluster.size() < least_sliding_shots / 2) return std::nullopt;
  if (!(squares > 0.0)) return DelayJitter{};
  const Estimated found = estimated(left, shots_of_cluster.size());
  const boost::math::students_t t(static_cast<double>(shots_of_cluster.size()) - components);
  const double half = boost::math::quantile(boost::math::complement(t, 0.025)) *
                      std::sqrt(std::max(0.0, found.covariance(jitter, jitter)));
  const double variance = found.variance[jitter];
  if (!std::isfinite(variance) || !std::isfinite(half)) return std::nullopt;
  const auto root = [](double value) { return std::sqrt(std::max(0.0, value)); };
  return DelayJitter{
      .value_s = root(variance), .lower_s = root(variance - half), .upper_s = root(variance + half)};
}

}  // namespace kerf::identification

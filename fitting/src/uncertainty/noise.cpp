#include "uncertainty/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "uncertainty/lattice.h"

namespace kerf::fitting {
namespace {

using Eigen::Index;

constexpr Index max_order = 32;
constexpr Index patience = 8;  // orders without an improvement before the search ends

double criterion(double count, double variance, double parameters, double price) {
  if (count - parameters - 2.0 <= 0.0) return std::numeric_limits<double>::infinity();
  return count * std::log(variance) + price * parameters * count / (count - parameters - 2.0);
}

/// Poles and zeros by turns, an octave apart, from a lowest frequency in cycles a row to the highest: nearly
/// 1/f.
std::vector<Pair> flicker_above(double lowest) {
  std::vector<Pair> pairs;
  for (double frequency = lowest; frequency < 0.2; frequency *= 4.0) {
    pairs.push_back({.zero = std::exp(-4.0 * M_PI * frequency), .pole = std::exp(-2.0 * M_PI * frequency)});
  }
  return pairs;
}

/// What drove the filters, at rest before each run.
Eigen::MatrixXd unfiltered(Eigen::MatrixXd rows, const std::vector<Rows>& runs,
                           const std::vector<Pair>& pairs) {
  Eigen::VectorXd input(rows.rows());
  Eigen::VectorXd before(rows.rows());
  for (const Pair& pair : pairs) {
    for (const Rows& run : runs) {
      if (run.count() == 0) continue;
      before = rows.col(run.begin);
      for (Index i = run.begin + 1; i < run.end; ++i) {
        input = rows.col(i);
        rows.col(i) += pair.zero * rows.col(i - 1) - pair.pole * before;
        before = input;
      }
    }
  }
  return rows;
}

/// a_1 ... a_order of a recursion that is kept as reflections.
Eigen::VectorXd coefficients_of(const std::vector<double>& reflections, Index order) {
  Eigen::VectorXd a(order);
  for (Index m = 0; m < order; ++m) {
    const double k = reflections[static_cast<std::size_t>(m)];
    a.head(m) += (k * a.head(m).reverse()).eval();
    a[m] = k;
  }
  return a;
}

/// Divides each row of white noise by its deviation over that of the innovations: the first rows of a run
/// are predicted from fewer.
Eigen::MatrixXd whitened(const Eigen::MatrixXd& series, const std::vector<Rows>& runs,
                         const Autoregression& noise) {
  const Index order = noise.order();
  Eigen::MatrixXd white = series;
  for (const Rows& run : runs) {
    const Index first = std::min(order, run.count());
    const auto share_left = [&](Index i) {
      return std::sqrt(1.0 - std::pow(noise.reflections[static_cast<std::size_t>(i)], 2));
    };
    double shrink = 1.0;
    for (Index i = order - 1; i >= first; --i) shrink *= share_left(i);  // of a run shorter than the order
    for (Index i = first - 1; i >= 0; --i) {
      const Eigen::VectorXd a = coefficients_of(noise.reflections, i);
      shrink *= share_left(i);
      white.col(run.begin + i).noalias() += series.middleCols(run.begin, i) * a.reverse();
      white.col(run.begin + i) *= shrink;
    }
    const Eigen::VectorXd a = noise.coefficients();
    const Index rest = run.begin + first;
    if (rest < run.end) {
      filter_by_sum(white.col(rest).data(), series.col(rest).data(), (run.end - rest) * series.rows(),
                    series.rows(), a.data(), order);
    }
  }
  return white;
}

/// Maps rows (Q, residuals) to (chol(C)^T Q, g).
Eigen::MatrixXd expectation(const Eigen::MatrixXd& white, double innovation_variance) {
  const Index r = white.rows() - 1;
  const Eigen::MatrixXd gram = white * white.transpose();
  const Eigen::LLT<Eigen::MatrixXd> normal(gram.topLeftCorner(r, r));
  Eigen::MatrixXd map = Eigen::MatrixXd::Identity(r + 1, r + 1);
  map.bottomLeftCorner(1, r) = -normal.solve(gram.topRightCorner(r, 1)).transpose();
  map.topLeftCorner(r, r) =
      std::sqrt(innovation_variance) * normal.matrixL().solve(Eigen::MatrixXd::Identity(r, r));
  return map;
}

/// Burg's estimate from series in rows whose squares add up to those of one series of as many columns. The
/// order is `most` if fixed, else that of least AICc; a known variance competes as noise without parameters.
Autoregression burg(const Eigen::MatrixXd& series, const std::vector<Rows>& runs, Index most, bool fixed,
                    double known_variance) {
  const auto count = static_cast<double>(series.cols());
  const double price = known_variance > 0.0 ? std::log(count) : 2.0;  // BIC to overturn what is known
  double variance = series.squaredNorm() / count;
  Autoregression best{.innovation_variance = variance};
  if (!(variance > 0.0)) return best;
  Lattice lattice(series, runs);
  std::vector<double> reflections;
  double least = criterion(count, variance, 1.0, price);
  if (known_variance > 0.0) {
    const double score = count * (std::log(known_variance) + variance / known_variance - 1.0);
    if (score < least) {
      least = score;
      best.innovation_variance = known_variance;
    }
  }
  for (Index order = 1; order <= most; ++order) {
    const double k = lattice.reflection();
    variance *= 1.0 - k * k;
    reflections.push_back(k);
    const double score = criterion(count, variance, static_cast<double>(order + 1), price);
    if (fixed || score < least) {
      best = {.reflections = reflections, .innovation_variance = variance};
      least = score;
    }
    if (!fixed && order >= best.order() + patience) break;
    if (order < most) lattice.apply(k);
  }
  return best;
}

/// The noise of one stage, whose rows are (Q^T, residuals).
Autoregression autoregression_of(const Eigen::MatrixXd& rows, const std::vector<Rows>& runs,
                                 double known_variance) {
  constexpr double negligible = 0.01;  // share of the noise at low frequency that the parameters took
  constexpr int free_passes = 3;       // in which the order may still change
  constexpr double settled = 1e-3;
  const Index r = rows.rows() - 1;
  const int max_passes = r <= 6 ? 20 : r <= 12 ? 8 : 2;  // each costs with the square of the parameters
  const auto count = static_cast<double>(rows.cols());
  const Index most = std::min(max_order, rows.cols() / 8);
  Autoregression noise = burg(rows.bottomRows(1), runs, most, false, known_variance);
  if (!(noise.innovation_variance > 0.0)) return noise;
  if (noise.innovation_variance != known_variance) {
    noise.innovation_variance *= count / (count - static_cast<double>(r));
  }
  const auto level_of = [](const Autoregression& of) {
    return of.innovation_variance * of.power_at_zero_frequency();
  };
  double level = level_of(noise);
  if (static_cast<double>(r) / count * std::max(1.0, level / noise.variance()) < negligible) return noise;
  for (int pass = 0; pass < max_passes; ++pass) {
    const Eigen::MatrixXd white = whitened(rows, runs, noise);
    const Eigen::MatrixXd filled = expectation(white, noise.innovation_variance) * rows;
    const bool fixed = pass >= free_passes;
    noise = burg(filled, runs, fixed ? noise.order() : most, fixed && noise.order() > 0, known_variance);
    const double next = level_of(noise);
    if (std::abs(next - level) < settled * level) break;
    level = next;
  }
  return noise;
}

/// Without flicker noise, or with as much of it as is likeliest: from four times as long as the longest run
/// upwards. Nothing tells where it ends below that.
Autoregression stage_of(const Eigen::MatrixXd& rows, const std::vector<Rows>& runs, double known_variance) {
  constexpr Index suspicious = 3;    // an order that long memory would need
  constexpr double hopeless = 30.0;  // of deviance: no other lowest frequency makes up for it
  Autoregression best = autoregression_of(rows, runs, known_variance);
  if (best.order() < suspicious) return best;
  double least = deviance(rows, runs, best);
  Index longest = 1;
  for (const Rows& run : runs) longest = std::max(longest, run.count());
  double before = std::numeric_limits<double>::infinity();
  for (double lowest = 0.25 / static_cast<double>(longest); lowest < 0.02; lowest *= 4.0) {
    const std::vector<Pair> pairs = flicker_above(lowest);
    const Eigen::MatrixXd driving = unfiltered(rows, runs, pairs);
    Autoregression flicker = autoregression_of(driving, runs, 0.0);
    const double score = deviance(driving, runs, flicker);
    if (score > before || score > least + hopeless) break;
    before = score;
    if (score >= least) continue;
    least = score;
    best = std::move(flicker);
    best.flicker = pairs;
  }
  return best;
}

/// Rows and their runs.
struct Looked {
  Eigen::MatrixXd rows;
  std::vector<Rows> runs;
};

/// Stretches from all over very many rows, `count` of these in all, each a run of its own (two where it goes
/// over the end of one). Q^T is made orthonormal there: what the parameters can take of these rows.
Looked part_of(const Eigen::MatrixXd& rows, const std::vector<Rows>& runs, Index count) {
  constexpr Index stretches = 16;
  const Index length = count / stretches;
  const Index r = rows.rows() - 1;
  Looked part{.rows = Eigen::MatrixXd(rows.rows(), stretches * length), .runs = {}};
  Index taken = 0;
  auto run = runs.begin();
  for (Index i = 0; i < stretches; ++i) {
    Index at = i * (rows.cols() - length) / (stretches - 1);
    const Index end = at + length;
    while (at < end) {
      while (run->end <= at) ++run;
      const Index here = std::min(end, run->end) - at;
      part.rows.middleCols(taken, here) = rows.middleCols(at, here);
      part.runs.push_back({taken, taken + here});
      taken += here;
      at += here;
    }
  }
  const Eigen::MatrixXd q = part.rows.topRows(r).transpose();
  const Eigen::MatrixXd basis = basis_of(gram(q)).determined;
  Eigen::MatrixXd all(basis.cols() + 1, part.rows.cols());
  all.topRows(basis.cols()).noalias() = basis.transpose() * part.rows.topRows(r);
  all.bottomRows(1) = part.rows.bottomRows(1);
  part.rows = std::move(all);
  return part;
}

/// The noise of one stage by all rows, or by a part of very many.
Stage looked_at(const Eigen::MatrixXd& rows, const std::vector<Rows>& runs, Index size, double known_variance,
                Index most) {
  const auto stage = [&](const Eigen::MatrixXd& those, const std::vector<Rows>& in) {
    return Stage{.size = size,
                 .model = stage_of(those, in, known_variance),
                 .count = static_cast<double>(those.cols() - (those.rows() - 1))};
  };
  if (rows.cols() <= most) return stage(rows, runs);
  const Looked part = part_of(rows, runs, most);
  return stage(part.rows, part.runs);
}

}  // namespace

double deviance(const Eigen::MatrixXd& rows, const std::vector<Rows>& runs, const Autoregression& noise) {
  const Index r = rows.rows() - 1;
  const auto count = static_cast<double>(rows.cols() - r);
  const Eigen::MatrixXd white = whitened(rows, runs, noise);
  const Eigen::LLT<Eigen::MatrixXd> factor(white * white.transpose());
  const Eigen::VectorXd pivots = factor.matrixLLT().diagonal();  // the last: what least squares leaves
  double first_rows = 0.0;
  for (Index i = 0; i < noise.order(); ++i) {
    const double k = noise.reflections[static_cast<std::size_t>(i)];
    Index predicted_from_fewer = 0;
    for (const Rows& run : runs) predicted_from_fewer += std::min(i + 1, run.count());
    first_rows -= static_cast<double>(predicted_from_fewer) * std::log1p(-k * k);
  }
  const auto parameters = static_cast<double>(noise.order() + 1);
  return count * std::log(noise.innovation_variance) + pivots[r] * pivots[r] / noise.innovation_variance +
         2.0 * pivots.head(r).array().log().sum() + first_rows +
         2.0 * parameters * count / std::max(1.0, count - parameters - 2.0);
}

Eigen::VectorXd Autoregression::coefficients() const { return coefficients_of(reflections, order()); }

double Autoregression::variance() const {
  double variance = innovation_variance;
  for (const double k : reflections) variance /= 1.0 - k * k;
  return variance;
}

double Autoregression::power_at_zero_frequency() const {
  double gain = 1.0 / (1.0 + coefficients().sum());
  for (const Pair& pair : flicker) gain *= (1.0 - pair.zero) / (1.0 - pair.pole);
  return gain * gain;
}

Eigen::MatrixXd Autoregression::covariance() const {
  Eigen::VectorXd lag(order());
  Eigen::VectorXd a(order());
  double left = variance();
  for (Index m = 0; m < order(); ++m) {
    lag[m] = m == 0 ? left : 0.0;
    if (m > 0) {
      const double k = reflections[static_cast<std::size_t>(m - 1)];
      lag[m] = -k * left - a.head(m - 1).dot(lag.segment(1, m - 1).reverse());
      a.head(m - 1) += (k * a.head(m - 1).reverse()).eval();
      a[m - 1] = k;
      left *= 1.0 - k * k;
    }
  }
  Eigen::MatrixXd result(order(), order());
  for (Index i = 0; i < order(); ++i) {
    for (Index j = 0; j < order(); ++j) result(i, j) = lag[std::abs(i - j)];
  }
  return result;
}

double Noise::variance_at_zero_frequency() const {
  double level = 1.0;
  for (const Stage& stage : stages) {
    level *= stage.model.power_at_zero_frequency();
  }
  return level * stages.back().model.innovation_variance;
}

Eigen::MatrixXd in_blocks(const Eigen::MatrixXd& rows, std::vector<Rows>& runs, Index size) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows.rows(), rows.cols() / size);
  Index block = 0;
  for (Rows& run : runs) {
    const Index begin = block;
    for (Index at = run.begin; at + size <= run.end; at += size) {
      result.col(block++) = rows.middleCols(at, size).rowwise().sum() / std::sqrt(static_cast<double>(size));
    }
    run = {begin, block};
  }
  return result.leftCols(block);
}

Noise noise_of(const Blocks& blocks, Index most) {
  constexpr Index coarser = 8;
  const Index r = blocks.rows.rows() - 1;
  const Index fewest = std::max<Index>(24, 4 * r);
  Noise noise;
  Eigen::MatrixXd rows = blocks.rows;
  std::vector<Rows> runs = blocks.runs;
  noise.stages.push_back(looked_at(rows, runs, 1, 0.0, most));
  while (rows.cols() >= coarser * fewest) {
    const Autoregression& fine = noise.stages.back().model;
    rows = in_blocks(whitened(unfiltered(std::move(rows), runs, fine.flicker), runs, fine), runs, coarser);
    if (rows.cols() < fewest) break;  // runs shorter than a block
    noise.stages.push_back(looked_at(rows, runs, coarser, fine.innovation_variance, most));
  }
  return noise;
}

}  // namespace kerf::fitting

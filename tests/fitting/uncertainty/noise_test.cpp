#include "uncertainty/noise.h"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "fitting/uncertainty/coverage.h"
#include "uncertainty/lattice.h"
#include "uncertainty/uncertainty.h"

namespace kerf::fitting {
namespace {

/// Covariance of `count` values in a row: that of the first few, carried on by the recursion itself,
/// r_k = -(a_1 r_{k-1} + ... + a_q r_{k-q}).
Eigen::MatrixXd covariance_of(const Autoregression& noise, Eigen::Index count) {
  const Eigen::MatrixXd first = noise.covariance();
  const Eigen::VectorXd a = noise.coefficients();
  Eigen::VectorXd lag(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    lag[k] = 0.0;
    if (k < noise.order())
      lag[k] = first(0, k);
    else
      for (Eigen::Index i = 0; i < noise.order(); ++i) lag[k] -= a[i] * lag[k - 1 - i];
  }
  Eigen::MatrixXd whole(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index k = 0; k < count; ++k) whole(i, k) = lag[std::abs(i - k)];
  }
  return whole;
}

double log_determinant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
}

// -2 log L = log |V| + log |Q^T V^-1 Q| + e^T P e, P = V^-1 - V^-1 Q (Q^T V^-1 Q)^-1 Q^T V^-1, by dense
// matrices; and 2 p n / (n - p - 2) for p parameters of the noise and n rows less those of the fit.
TEST(Deviance, IsThatOfTheWholeCovarianceMatrix) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  const auto drawn = [&] { return normal(random); };
  const std::vector<Rows> runs{{0, 25}, {25, 58}, {58, 60}};  // the last is shorter than what is remembered
  const Eigen::MatrixXd columns = Eigen::MatrixXd::NullaryExpr(60, 2, drawn);
  const Eigen::MatrixXd q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() * Eigen::MatrixXd::Identity(60, 2);
  const Eigen::VectorXd e = Eigen::VectorXd::NullaryExpr(60, drawn);
  Eigen::MatrixXd rows(3, 60);
  rows << q.transpose(), e.transpose();

  for (const Autoregression& noise :
       {Autoregression{.reflections = {}, .flicker = {}, .innovation_variance = 0.5},
        Autoregression{.reflections = {-0.6, 0.3, -0.2}, .flicker = {}, .innovation_variance = 2.5}}) {
    Eigen::MatrixXd v = noise.innovation_variance * Eigen::MatrixXd::Identity(60, 60);
    for (const Rows& run : runs) {
      if (noise.order() == 0) continue;
      v.block(run.begin, run.begin, run.count(), run.count()) = covariance_of(noise, run.count());
    }
    const Eigen::LLT<Eigen::MatrixXd> whole(v);
    const Eigen::MatrixXd weighed = whole.solve(q);
    const Eigen::LLT<Eigen::MatrixXd> normal_equations(q.transpose() * weighed);
    const double left = e.dot(whole.solve(e)) -
                        (weighed.transpose() * e).dot(normal_equations.solve(weighed.transpose() * e));
    const double n = 58.0;
    const auto p = static_cast<double>(noise.order() + 1);
    EXPECT_NEAR(
        deviance(rows, runs, noise),
        log_determinant(whole) + log_determinant(normal_equations) + left + 2.0 * p * n / (n - p - 2.0), 1e-8)
        << "order " << noise.order();
  }
}

// (J^T J)^-1 (J^T Sigma J) (J^T J)^-1 with the covariance Sigma of the noise that was found, as a dense
// matrix. In these draws the wave on which the noise's memory fades passes through zero long before it has
// faded.
TEST(Uncertainty, IsThatOfTheWholeCovarianceMatrix) {
  constexpr Eigen::Index count = 60;
  constexpr double turn = 1.3;  // [rad] a row, of the resonance and of what is fitted
  constexpr double pole = 0.95;
  for (const unsigned seed : {36U, 55U, 137U}) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> noise{0.0, 0.0};
    while (noise.size() < 1002 + count) {
      const double resonance =
          2.0 * pole * std::cos(turn) * noise.back() - pole * pole * noise[noise.size() - 2];
      noise.push_back(normal(random) + resonance);
    }
    Linearisation wave{.jacobian = Eigen::MatrixXd(count, 1),
                       .residuals = Eigen::Map<Eigen::VectorXd>(noise.data() + 1002, count)};
    for (Eigen::Index i = 0; i < count; ++i) wave.jacobian(i, 0) = std::sin(turn * static_cast<double>(i));
    const Eigen::VectorXd column = wave.jacobian.col(0);
    wave.residuals -= column * (column.dot(wave.residuals) / column.squaredNorm());

    const Eigen::MatrixXd normal_equations = gram(wave.jacobian);
    const Noise found = noise_of(coarsen(wave, normal_equations, basis_of(normal_equations).determined));
    ASSERT_EQ(found.stages.size(), 1U) << seed;
    const Eigen::MatrixXd sigma = covariance_of(found.stages[0].model, count);
    const double truth = column.dot(sigma * column) / std::pow(column.squaredNorm(), 2);
    EXPECT_NEAR(uncertainty_of(wave, 0.95).covariance(0, 0), truth, 1e-6 * truth) << seed;
  }
}

/// Whether the intervals of a level, known to be zero, hold it, and how wide they are.
struct LevelsHeld {
  int of = 0;
  int held = 0;
  double width = 0.0;  ///< the mean
};

LevelsHeld held_by(const test::Noise& noise, Eigen::Index most_blocks) {
  constexpr Eigen::Index count = 16384;
  LevelsHeld all{.of = 200};
  for (int seed = 0; seed < all.of; ++seed) {
    const Eigen::VectorXd values = noise.draw(count, 1.0, static_cast<std::uint64_t>(seed));
    Linearisation level{.jacobian = Eigen::MatrixXd::Ones(count, 2), .residuals = values};
    for (Eigen::Index i = 0; i < count; ++i) level.jacobian(i, 1) = std::sin(1.1 * static_cast<double>(i));
    const Eigen::VectorXd fitted = gram(level.jacobian).ldlt().solve(level.jacobian.transpose() * values);
    level.residuals -= level.jacobian * fitted;
    const Uncertainty known = uncertainty_of(level, 0.95, most_blocks);
    const double half = known.quantile[0] * std::sqrt(known.covariance(0, 0));
    all.held += std::abs(fitted[0]) <= half ? 1 : 0;
    all.width += 2.0 * half / all.of;
  }
  return all;
}

// One sixteenth of the blocks: the intervals of a level in noise with a memory of up to 39 rows, which the
// wave beside it keeps from being taken together, hold it as often. They are no narrower than by all blocks,
// and little wider: what so few do not say of the noise, Student's t knows.
TEST(Noise, OfAPartOfTheBlocksGivesIntervalsThatHold) {
  for (const test::Noise& noise :
       {test::Noise::white(), test::Noise::first_order("memory of 39 rows", 0.95), test::Noise::resonant()}) {
    const LevelsHeld by_part = held_by(noise, 1024);
    const LevelsHeld by_all = held_by(noise, 1 << 20);
    // 99.9 % of binomial draws of 200 at 95 %, by SciPy: binom.ppf([0.0005, 0.9995], 200, 0.95).
    EXPECT_GE(by_part.held, 179) << noise.name;
    EXPECT_LE(by_part.held, 198) << noise.name;
    EXPECT_GE(by_part.width, 0.95 * by_all.width) << noise.name;
    EXPECT_LE(by_part.width, 1.25 * by_all.width) << noise.name;
  }
}

// What is found of the blocks where nothing of a derivative is, is found without it.
TEST(Noise, OfAPartThatAParameterDoesNotMoveIsFound) {
  constexpr Eigen::Index count = 20000;
  Linearisation late{.jacobian = Eigen::MatrixXd::Zero(count, 2),
                     .residuals = test::Noise::white().draw(count, 0.5, 3)};
  late.jacobian.col(0).setOnes();
  for (const Eigen::Index moved : {5, 3001, 10000}) {  // by turns in a stretch that is looked at and in none
    late.jacobian.col(1).setZero();
    late.jacobian(moved, 1) = 1.0;
    const Uncertainty known = uncertainty_of(late, 0.95, 512);
    EXPECT_NEAR(std::sqrt(known.covariance(0, 0)), 0.5 / std::sqrt(20000.0), 0.1 * 0.5 / std::sqrt(20000.0));
    EXPECT_NEAR(std::sqrt(known.covariance(1, 1)), 0.5, 0.1);
  }
}

/// Numbers that never come again.
Eigen::MatrixXd golden(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd all(rows, columns);
  for (Eigen::Index i = 0; i < all.size(); ++i)
    all.data()[i] = std::fmod(0.6180339887498949 * static_cast<double>(i + 1), 1.0) - 0.45;
  return all;
}

// Burg's reflections of several series, order by order: k = -2 sum f b / sum (f f + b b), the backward errors
// a row behind. Runs are shorter than the orders and longer than a stretch that is summed at once.
TEST(Lattice, ReflectsAsBurgsSumsDoOverRunsOfAnyLength) {
  for (const Eigen::Index rows : {1, 2, 3, 5}) {
    const std::vector<Rows> runs{{0, 3}, {3, 44}, {44, 44}, {44, 1500}};
    const Eigen::MatrixXd series = golden(rows, 1500);
    Lattice lattice(series, runs);
    Eigen::MatrixXd forward = series;
    Eigen::MatrixXd backward = series;  // of each row, where it stands
    for (Eigen::Index order = 0; order < 7; ++order) {
      double product = 0.0;
      double energy = 0.0;
      for (const Rows& run : runs) {
        for (Eigen::Index i = run.begin + order + 1; i < run.end; ++i) {
          product += forward.col(i).dot(backward.col(i - 1));
          energy += forward.col(i).squaredNorm() + backward.col(i - 1).squaredNorm();
        }
      }
      const double k = -2.0 * product / energy;
      ASSERT_NEAR(lattice.reflection(), k, 1e-13) << rows << " rows, order " << order;
      lattice.apply(lattice.reflection());
      for (const Rows& run : runs) {
        for (Eigen::Index i = run.end - 1; i > run.begin + order; --i) {
          const Eigen::VectorXd before = backward.col(i - 1);
          backward.col(i) = before + k * forward.col(i);
          forward.col(i) += k * before;
        }
      }
    }
  }
}

TEST(Lattice, FiltersByTheRowsBefore) {
  const std::vector<double> a{0.5, -0.25, 0.125};
  for (const Eigen::Index rows : {1, 3, 4}) {
    for (const Eigen::Index count : {1, 2, 9, 40}) {
      const Eigen::MatrixXd series = golden(rows, 3 + count);
      Eigen::MatrixXd filtered(rows, count);
      filter_by_sum(filtered.data(), series.col(3).data(), filtered.size(), rows, a.data(), 3);
      const Eigen::MatrixXd expected = series.rightCols(count) + 0.5 * series.middleCols(2, count) -
                                       0.25 * series.middleCols(1, count) + 0.125 * series.leftCols(count);
      EXPECT_LT((filtered - expected).norm(), 1e-14 * expected.norm()) << rows << " rows, " << count;
    }
  }
}

}  // namespace
}  // namespace kerf::fitting

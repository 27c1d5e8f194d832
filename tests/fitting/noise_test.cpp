#include "uncertainty/noise.h"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <gtest/gtest.h>

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
  const std::vector<Rows> runs{{0, 25}, {25, 60}};
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

}  // namespace
}  // namespace kerf::fitting

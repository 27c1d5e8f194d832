#include "psychometric/subject_integral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace kerf::psychophysics {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double steepest_log_slope = 12.0;  ///< a step, on an axis of unit span; curves beyond it are alike

/// Of Hermite's polynomials of exp(-x^2): 7 points, exact up to degree 13. [AbramowitzStegun1964], 25.10.
constexpr std::array<double, 7> hermite_at{-2.651961356835233, -1.673551628767471, -0.816287882858965, 0.0,
                                           0.816287882858965,  1.673551628767471,  2.651961356835233};
constexpr std::array<double, 7> hermite_weight{0.0009717812450995, 0.0545155828191270, 0.4256072526101278,
                                               0.8102646175568073, 0.4256072526101278, 0.0545155828191270,
                                               0.0009717812450995};
constexpr std::size_t quadrature_points = hermite_at.size() * hermite_at.size();

/// Log-likelihood of a subject's answers at a curve (threshold on the scaled axis, ln slope), its gradient
/// and Fisher's information.
struct CurveScore {
  double value = 0.0;
  Vector2d gradient = Vector2d::Zero();
  Matrix2d information = Matrix2d::Zero();
};

CurveScore score_at(const Problem& problem, double lapse, const Vector2d& curve) {
  const Score all = score(problem, {curve[0], std::min(curve[1], steepest_log_slope), lapse, 0.0});
  CurveScore at{.value = all.log_likelihood};
  at.gradient << all.gradient[threshold_index], all.gradient[slope_index];
  const double both = all.information[slope_index][threshold_index];
  at.information << all.information[threshold_index][threshold_index], both, both,
      all.information[slope_index][slope_index];
  if (curve[1] < steepest_log_slope) return at;
  at.gradient[1] = 0.0;
  at.information.row(1).setZero();
  at.information.col(1).setZero();
  return at;
}

/// ln of the integral of one subject, and its gradient by Fisher's identity: the mean, over the curves that
/// the subject may have, of the gradient given the curve.
class SubjectIntegral {
 public:
  SubjectIntegral(const Problem& problem, double lapse, const Population& population)
      : problem_(problem), lapse_(lapse), population_(population) {}

  [[nodiscard]] double log_integral(Parameters* gradient) const {
    const auto [mode, root] = mode_and_root();
    std::array<double, quadrature_points> logs{};
    std::array<Vector2d, quadrature_points> deviates;
    std::array<Vector2d, quadrature_points> slopes;
    for (std::size_t i = 0; i < quadrature_points; ++i) {
      const std::size_t first = i / hermite_at.size();
      const std::size_t second = i % hermite_at.size();
      const Vector2d node(hermite_at[first], hermite_at[second]);
      deviates[i] = mode + std::numbers::sqrt2 * (root * node);
      const CurveScore at = score_of(deviates[i]);
      logs[i] = at.value - 0.5 * deviates[i].squaredNorm() + node.squaredNorm() +
                std::log(hermite_weight[first] * hermite_weight[second]);
      slopes[i] = at.gradient;
    }
    const double largest = *std::max_element(logs.begin(), logs.end());
    double sum = 0.0;
    for (const double each : logs) sum += std::exp(each - largest);
    const double log_value = largest + std::log(sum);
    for (std::size_t i = 0; i < quadrature_points && gradient != nullptr; ++i) {
      const double weight = std::exp(logs[i] - log_value);
      (*gradient)[0] += weight * slopes[i][0];
      (*gradient)[1] += weight * slopes[i][1];
      (*gradient)[2] += weight * slopes[i][0] * deviates[i][0];
      (*gradient)[3] += weight * slopes[i][1] * deviates[i][0];
      (*gradient)[4] += weight * slopes[i][1] * deviates[i][1];
    }
    // du = 2 |root| dnode, over the 2 pi of the normal distribution.
    return log_value + std::log(root.determinant() / std::numbers::pi);
  }

 private:
  struct Mode {
    Vector2d at;
    Matrix2d root;  ///< of the inverse of the information there: what the integrand is wide
  };

  [[nodiscard]] CurveScore score_of(const Vector2d& u) const {
    return score_at(problem_, lapse_, population_.mean + population_.factor * u);
  }

  /// With the normal distribution of the deviates.
  [[nodiscard]] CurveScore penalised(const Vector2d& u) const {
    CurveScore at = score_of(u);
    const Matrix2d& factor = population_.factor;
    at.value -= 0.5 * u.squaredNorm();
    at.gradient = factor.transpose() * at.gradient - u;
    at.information = factor.transpose() * at.information * factor + Matrix2d::Identity();
    return at;
  }

  [[nodiscard]] Mode mode_and_root() const {
    Vector2d u = Vector2d::Zero();
    CurveScore at = penalised(u);
    for (int round = 0; round < 60; ++round) {
      const Vector2d step = at.information.ldlt().solve(at.gradient);
      if (step.squaredNorm() < 1e-20) break;
      double part = 1.0;
      CurveScore there = penalised(u + step);
      while (!(there.value >= at.value) && part > 1e-6) {
        part *= 0.5;
        there = penalised(u + part * step);
      }
      if (part <= 1e-6) break;
      u += part * step;
      at = there;
    }
    return {.at = u, .root = Matrix2d(at.information.inverse()).llt().matrixL()};
  }

  const Problem& problem_;
  double lapse_;
  const Population& population_;
};

}  // namespace

double log_integral(const Problem& problem, double lapse, const Population& population,
                    Parameters* gradient) {
  return SubjectIntegral(problem, lapse, population).log_integral(gradient);
}

}  // namespace kerf::psychophysics

#include "minimise_over_kinks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

namespace kerf::fitting {
namespace {

/// By how much of the sum of squares it rises from the middle of a neighbourhood to its border.
constexpr double neighbourhoods[] = {1e-5, 1e-6, 1e-7, 1e-8};
constexpr int most_steps_around = 4;  ///< in each of them
/// What tells a kink from a minimum: by how much the sum of squares rises more on one side than on the other,
/// over what it rises; or how much lower it is beside it.
constexpr double uneven = 0.01;
constexpr double lower = 1e-10;

/// Axes along which a sum of squares rises alike, each as long as it takes to rise by so much.
Eigen::MatrixXd axes_of(const Sums& sums, double rise) {
  constexpr double least = 1e-12;   // of the largest: below this the sums tell nothing
  constexpr double longest = 0.05;  // of a logarithm, or of what is as large as one
  const Eigen::VectorXd diagonal = sums.normal.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = (diagonal.array() > 0.0).select(diagonal.cwiseInverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(scale.asDiagonal() * sums.normal *
                                                                scale.asDiagonal());
  const Eigen::VectorXd values = spectrum.eigenvalues().cwiseMax(least * spectrum.eigenvalues().maxCoeff());
  Eigen::MatrixXd axes = scale.asDiagonal() * spectrum.eigenvectors() *
                         (rise * sums.squares * values.cwiseInverse()).cwiseSqrt().asDiagonal();
  for (auto axis : axes.colwise()) axis *= std::min(1.0, longest / axis.norm());
  return axes;
}

/// Mean and slope of the score over a neighbourhood, along its axes, and how unevenly it rises there.
struct Around {
  Eigen::VectorXd score;
  Eigen::MatrixXd curvature;
  double unevenness = 0.0;
};

class KinkSearch {
 public:
  KinkSearch(const Minimum& from, const Objective& objective, const Bounds& bounds)
      : best_(from), objective_(objective), bounds_(bounds) {}

  /// False where there is nothing to step over.
  [[nodiscard]] bool step_in(double neighbourhood) {
    const double begun = best_.sums.squares;
    for (int i = 0; i < most_steps_around; ++i) {
      const double before = best_.sums.squares;
      const Eigen::VectorXd middle = best_.at;
      const Eigen::MatrixXd axes = axes_of(best_.sums, neighbourhood);
      const auto around = look_around(middle, axes);
      if (!around) return false;
      if (i == 0 && around->unevenness < uneven * neighbourhood && best_.sums.squares > (1.0 - lower) * begun)
        return false;
      const auto down = solve_positive(around->curvature, -around->score);
      if (down) (void)look_at(middle + axes * *down);
      if (!(best_.sums.squares < (1.0 - 1e-3 * neighbourhood) * before)) break;
    }
    return true;
  }
  [[nodiscard]] Minimum best() && { return std::move(best_); }

 private:
  /// Keeps the least that was seen.
  [[nodiscard]] std::optional<Sums> look_at(const Eigen::VectorXd& at) {
    const Eigen::VectorXd inside = at.cwiseMax(bounds_.lower).cwiseMin(bounds_.upper);
    Sums sums;
    ++best_.iterations;
    if (!objective_.evaluate(inside, sums) || !std::isfinite(sums.squares)) return std::nullopt;
    if (sums.squares < best_.sums.squares) {
      best_.at = inside;
      best_.sums = sums;
    }
    return sums;
  }

  std::optional<Around> look_around(const Eigen::VectorXd& middle, const Eigen::MatrixXd& axes) {
    const Eigen::Index p = axes.cols();
    const double squares = best_.sums.squares;
    Around around{.score = Eigen::VectorXd::Zero(p), .curvature = Eigen::MatrixXd(p, p)};
    for (Eigen::Index k = 0; k < p; ++k) {
      const auto above = look_at(middle + axes.col(k));
      const auto below = look_at(middle - axes.col(k));
      if (!above || !below) return std::nullopt;
      around.unevenness =
          std::max(around.unevenness, 0.5 * std::abs(above->squares - below->squares) / squares);
      around.score += axes.transpose() * (above->score + below->score) / (2.0 * static_cast<double>(p));
      around.curvature.col(k) = 0.5 * axes.transpose() * (above->score - below->score);
    }
    around.curvature = 0.5 * (around.curvature + around.curvature.transpose().eval());
    return around;
  }

  Minimum best_;
  const Objective& objective_;
  const Bounds& bounds_;
};

}  // namespace

Minimum step_over_kinks(const Minimum& from, const Objective& objective, const Bounds& bounds) {
  KinkSearch search(from, objective, bounds);
  for (const double neighbourhood : neighbourhoods) {
    if (!search.step_in(neighbourhood)) break;
  }
  return std::move(search).best();
}

}  // namespace kerf::fitting

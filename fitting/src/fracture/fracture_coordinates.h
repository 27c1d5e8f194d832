#pragma once

#include <vector>

#include "problem.h"

namespace kerf::fitting {

/// Fracture (models/fracture.h) by what decides which rows break: logarithms of amplitude, exponent, depth of
/// yielding d and length l of the crack that a fracture makes,
///
///     Uy = alpha L0 / beta expm1(beta d / L0),   Jc w = Uy / l.
///
/// Which rows are whole, which break and where the tip then stands follow from d and l alone. Between the
/// values of d and l at which a row comes to break, or to lie before the tip, the force is smooth in all
/// four.
class FractureCoordinates {
 public:
  explicit FractureCoordinates(const Problem& problem);

  static constexpr Eigen::Index count = 4;
  static constexpr Eigen::Index amplitude = 0, exponent = 1, depth = 2, crack = 3;

  [[nodiscard]] Eigen::VectorXd at(const std::vector<double>& values) const;
  /// Within the ranges of the law.
  [[nodiscard]] std::vector<double> values(const Eigen::VectorXd& at) const;
  /// Whether the law of these coordinates lies within its ranges.
  [[nodiscard]] bool admit(const Eigen::VectorXd& at) const;
  /// Derivatives of the logarithms of amplitude, exponent, yield energy and toughness by these coordinates.
  [[nodiscard]] Eigen::Matrix4d slopes(const Eigen::VectorXd& at) const;
  [[nodiscard]] Bounds bounds() const;
  [[nodiscard]] double thickness() const { return thickness_; }

 private:
  [[nodiscard]] std::vector<double> unbounded(const Eigen::VectorXd& at) const;

  const Problem& problem_;
  double thickness_;
};

}  // namespace kerf::fitting

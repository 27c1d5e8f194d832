#pragma once

#include <vector>

#include "specimens.h"

namespace kerf::population {

/// t_b^2 and t_w^2 of `estimate_group`.
struct Variances {
  double between = 0.0;
  double within = 0.0;
};

/// A specimen at given variances: its mean by a = 1 / (s^2 + t_w^2), sums of a and a^2, the variance of the
/// mean.
struct SpecimenMean {
  double mean = 0.0;
  double weight = 0.0;    ///< A = sum a
  double squares = 0.0;   ///< B = sum a^2
  double about = 0.0;     ///< sum a (y - m)^2
  double variance = 0.0;  ///< v = t_b^2 + 1 / A
};

/// What REML's loss needs, of all specimens.
struct Fitted {
  std::vector<SpecimenMean> specimens;
  double mean = 0.0;
  double weight = 0.0;    ///< W = sum 1 / v
  double q = 0.0;         ///< sum (m - mu)^2 / v: chi^2 of n - 1
  double within_q = 0.0;  ///< sum of `about`: chi^2 of N - n
};

[[nodiscard]] Fitted fitted(const std::vector<Specimen>& specimens, const Variances& variances);

/// Which variances can be told apart, and their least values: of recordings above 0 where recordings have no
/// error of their own, or equal values would be infinitely likely.
struct Model {
  bool has_within = true;  ///< false: t_w = 0, and t_b stands for both
  Variances least;
};

/// Variances by restricted maximum likelihood, of values whose spread is about 1. Two specimens at least.
[[nodiscard]] Variances reml(const std::vector<Specimen>& specimens, const Model& model);

}  // namespace kerf::population

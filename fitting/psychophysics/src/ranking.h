#pragma once

#include <vector>

#include <kerf/psychophysics/comparisons.h>

namespace kerf::psychophysics {

using Matrix = std::vector<std::vector<double>>;

/// Of the log likelihood of worths. All rows and columns add up to 0, since only differences count.
struct RankingDerivatives {
  std::vector<double> gradient;
  Matrix information;
};

[[nodiscard]] RankingDerivatives derivatives(const Wins& wins, Scale scale, const std::vector<double>& worth);

/// By Gauss and Jordan; the matrix is positive definite, so that no pivot is looked for.
[[nodiscard]] Matrix inverse(Matrix a);

/// The covariance of worths that add up to 0: the generalised inverse of an information, which has 1/n added
/// everywhere and taken away again.
[[nodiscard]] Matrix covariance_of(Matrix information);

}  // namespace kerf::psychophysics

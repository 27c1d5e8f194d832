#pragma once

#include <vector>

#include <kerf/population/group.h>

#include "reml.h"

namespace kerf::population {

/// Limits of t_w: the exact Q-profile, over N - n degrees of freedom.
[[nodiscard]] Interval within_limits(const std::vector<Specimen>& specimens, const Model& model,
                                     double confidence);

/// What the data leave open of both variances, as nodes of equal rank whose weights add up to 1 (Gauss and
/// Legendre, over the quantiles of the two chi^2).
class OpenVariances {
 public:
  OpenVariances(const std::vector<Specimen>& specimens, const Model& model);

  /// Limits of t_b.
  [[nodiscard]] Interval between_limits(double confidence) const;
  /// Limits of the true mean of a specimen that was not recorded.
  [[nodiscard]] Interval of_the_next(double confidence) const;

 private:
  struct Within {
    double variance = 0.0;
    double weight = 1.0;
  };
  [[nodiscard]] double between_at(double q, double within) const;

  const std::vector<Specimen>& specimens_;
  Model model_;
  std::vector<Within> within_;
};

}  // namespace kerf::population

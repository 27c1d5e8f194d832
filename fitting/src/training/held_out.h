#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "training/training.h"

namespace kerf::fitting {

/// Errors on samples that no fit was shown.
struct FoldErrors {
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< infinite if a fold could not be fitted
  std::vector<double> folds;                               ///< root mean square of each fold; empty if none
};
struct HeldOut {
  FoldErrors fitted;
  FoldErrors rendered;  ///< nothing where nothing renders
};

/// Trains on all samples of positive weight but those of one fold, and judges by these, fold by fold.
/// Nothing where fewer than two folds are left.
[[nodiscard]] HeldOut held_out(const std::function<Trained(Weights seen)>& train_on, const Samples& samples,
                               const Weights& weights, std::size_t threads,
                               const decltype(FitOptions::render)& render = {});

/// Root mean square of the samples that held_out() would judge by; NaN if there are none. Where both are
/// least squares it never gives less than this of the law that was shown all: shown fewer, a law leaves no
/// more in those than that one does, and in all no less, hence no less in the others.
[[nodiscard]] double least_held_out(const std::vector<double>& residuals, const Samples& samples,
                                    const Weights& weights);

/// Mean difference of the folds' mean squares, and its standard error; 0 where they cannot be paired.
struct Paired {
  double mean = 0.0;
  double std_error = 0.0;
};
[[nodiscard]] Paired paired(const std::vector<double>& folds, const std::vector<double>& others);

/// Standard error of the root of the mean square, by the spread from fold to fold; NaN for fewer than two.
[[nodiscard]] double standard_error(const FoldErrors& errors);

}  // namespace kerf::fitting

#pragma once

#include <cstddef>
#include <vector>

#include "kerf/fitting/fit.h"

namespace kerf::fitting {

/// A checked copy of a series in the form in which residuals are computed.
struct Samples {
  std::vector<models::Motion> motion;
  std::vector<double> period_s;  ///< time since the sample before
  std::vector<double> force;
  std::vector<std::size_t> fold;  ///< held out in that fold of the cross-validation; no_fold: never
  std::size_t folds = 0;
  double least = 0.0;  ///< smallest penetration
  double most = 0.0;   ///< largest penetration
  double median_period_s = 0.0;
  double duration_s = 0.0;
  bool has_cycles = false;

  static constexpr std::size_t no_fold = static_cast<std::size_t>(-1);
  [[nodiscard]] std::size_t size() const noexcept { return force.size(); }
};

/// @throws std::invalid_argument if the series cannot be fitted at all.
[[nodiscard]] Samples check_series(const Series& series, std::size_t folds);

/// Which samples count in a fit: all, or all but those held out in one fold.
using Mask = std::vector<bool>;
[[nodiscard]] Mask all_of(const Samples& samples);
[[nodiscard]] Mask without_fold(const Samples& samples, std::size_t fold);

/// The force that a law gives along the samples, from a fresh state.
[[nodiscard]] std::vector<double> rendered(const models::Law& law, const Samples& samples);

}  // namespace kerf::fitting

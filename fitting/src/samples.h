#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kerf/fitting/fit.h"

namespace kerf::fitting {

/// One recording among the samples: rows [begin, end), through which a law runs from a fresh state.
struct Run {
  std::size_t begin = 0;
  std::size_t end = 0;
  double noise_n = 0.0;        ///< 0: not known
  double contact_error = 0.0;  ///< standard error of where the penetration is zero
};

/// A checked copy of the recordings in the form in which residuals are computed.
struct Samples {
  std::vector<models::Motion> motion;
  std::vector<double> period_s;  ///< time since the sample before
  std::vector<double> force;
  std::vector<std::uint8_t> counts;  ///< 0: a law only runs through it
  std::vector<std::uint32_t> cycle;  ///< 0 for none
  std::vector<std::uint32_t> fold;   ///< held out in that fold of the cross-validation; no_fold: never
  std::vector<Run> runs;
  std::size_t folds = 0;
  double least = 0.0;          ///< smallest penetration
  double most = 0.0;           ///< largest penetration
  double fastest = 0.0;        ///< largest velocity, either way
  double largest_force = 0.0;  ///< either way
  double median_period_s = 0.0;
  double duration_s = 0.0;  ///< of the longest run
  bool has_cycles = false;
  bool is_even = true;   ///< one period throughout
  bool all_seen = true;  ///< no row is left out or held back for a test

  static constexpr std::uint32_t no_fold = static_cast<std::uint32_t>(-1);
  static constexpr std::uint32_t test = static_cast<std::uint32_t>(-2);  ///< a fold that no fit sees
  [[nodiscard]] std::size_t size() const noexcept { return force.size(); }
  /// Whether a fit may see that row.
  [[nodiscard]] bool is_seen(std::size_t i) const { return counts[i] != 0 && fold[i] != test; }
};

struct FoldOptions {
  std::size_t folds = 5;
  double test_share = 0.0;
};

/// @throws std::invalid_argument if the series cannot be fitted at all.
[[nodiscard]] Samples check_series(std::span<const Series> recordings, const FoldOptions& options);

/// Every so many samples of each run, at least `count` of them in all, or all there are. A law that is exact
/// for motion that is linear between samples sees nearly the same motion.
[[nodiscard]] Samples thinned(const Samples& samples, std::size_t count);

using Numbers = Eigen::Map<const Eigen::ArrayXd>;
inline Numbers numbers_of(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}
/// Of a column what a fit may see of it; `kept` takes the numbers where that is not all.
[[nodiscard]] Numbers seen_of(const Samples& samples, std::span<const double> column,
                              std::vector<double>& kept);

/// How much each sample counts; 0: not at all.
using Weights = std::vector<double>;
/// All samples that a fit may see, each run by its noise where every run's is known.
[[nodiscard]] Weights all_of(const Samples& samples);
/// The weights of a thinned series.
[[nodiscard]] Weights thinned_weights(const Samples& samples, const Weights& weights, const Samples& few);
/// The same less those of one fold.
[[nodiscard]] Weights without_fold(const Samples& samples, const Weights& weights, std::size_t fold);
/// Standard deviation of white noise from row to row, by what a straight line through three rows leaves: of
/// white noise the second difference has six times the variance, of motion that is sampled finely it has
/// none. Of the rows that `weights` have, or of all where it is empty.
[[nodiscard]] double noise_of_rows(const Samples& samples, const Weights& weights = {});

}  // namespace kerf::fitting

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "between.h"

namespace kerf::compare {

/// got(i) = gain expected(i - ticks) + offset
struct LagFit {
  double ticks = 0.0;
  double std_error = 0.0;  ///< of the ticks, with residuals that hang together counted as fewer
  double gain = 1.0;
  double offset = 0.0;
  Kernel kernel = Kernel::linear;
  bool is_longer = false;  ///< beyond the most ticks that were looked for less would be left: it is unknown
};

struct LagFitOptions {
  std::size_t most_ticks = 0;
  bool free_gain = false;  ///< else the gain is 1 and the offset 0
};

/// The lag at which two signals of one length differ least. None for signals that are too short, or without
/// any change.
[[nodiscard]] std::optional<LagFit> fit_lag(std::span<const double> expected, std::span<const double> got,
                                            const LagFitOptions& options);

/// Rows that follow each other.
struct Stretch {
  std::size_t begin = 0;
  std::size_t count = 0;
  [[nodiscard]] std::span<const double> of(const std::vector<double>& values) const {
    return std::span(values).subspan(begin, count);
  }
};

/// The longest without a gap in time: rows on both sides of one make a jump that a lag would be told from.
/// All rows where there is none, or no stretch of a quarter of them.
[[nodiscard]] Stretch longest_stretch(const std::vector<double>& time_s, std::size_t rows, double period_s);

/// Rows that stand for all of them: all, or blocks of them over the whole.
[[nodiscard]] std::vector<std::size_t> rows_for_all(std::size_t begin, std::size_t end);

}  // namespace kerf::compare

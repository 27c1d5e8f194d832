#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "prepare/onset.h"

namespace kerf::bench {

/// How far something is off, over many cases.
struct ErrorOf {
  double bias_s = 0.0;    ///< median of the signed errors; negative: early
  double median_s = 0.0;  ///< of their sizes
  double percentile_90_s = 0.0;
};

/// Contacts that were found against those that somebody labelled.
struct ContactScore {
  std::size_t labelled = 0;
  std::size_t detected = 0;
  std::size_t found = 0;       ///< labelled ones with a detected one of their own
  std::size_t missed = 0;      ///< labelled - found
  std::size_t false_ones = 0;  ///< detected ones that overlap no label
  std::size_t split_up = 0;    ///< detected ones beyond the first on a label that is already found
  ErrorOf begin;               ///< of those found; begin of the first row
  ErrorOf end;                 ///< their last row
  double precision = 0.0;      ///< rows detected and labelled over rows detected; 0 for none
  double recall = 0.0;         ///< the same over rows labelled
  double f1 = 0.0;
};

/// A detected span belongs to the label that it shares most rows with, and a label to the detected span,
/// among those that belong to it, that shares most. Spans of each list are in order and apart.
[[nodiscard]] ContactScore score_contacts(std::span<const RowSpan> detected,
                                          std::span<const RowSpan> labelled, std::span<const double> time_s);

/// Runs of rows in which a channel has this value.
[[nodiscard]] std::vector<RowSpan> labelled_spans(std::span<const double> labels, double value);

}  // namespace kerf::bench

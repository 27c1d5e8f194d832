#pragma once

#include <cstdint>
#include <span>

#include <kerf/psychophysics/binomial.h>

namespace kerf::psychophysics {

struct HomogeneityOptions {
  int samples = 4999;  ///< tables that are drawn where there are too many to be added up
  std::uint64_t seed = 1;
};

struct Homogeneity {
  double statistic = 0.0;      ///< sum over groups of (k - n p)^2 / (n p (1 - p)), p of all: Pearson's
  int degrees_of_freedom = 0;  ///< groups with trials, less one
  double p = 1.0;
  bool is_exact = true;  ///< all tables were added up
};

/// Whether groups of answers (of subjects, of slots) share one probability of success: the exact test of
/// Fisher, Freeman and Halton [FreemanHalton1951]. Given the trials of each group and all successes, tables
/// have
///
///     P(k_1 ... k_m) = product of C(n_i, k_i) / C(n, k)
///
/// and p is the sum over all that are no more probable than what was seen. Of more than 200,000 tables some
/// are drawn: p = (1 + drawn that are no more probable) / (1 + all drawn). Groups without trials do not
/// count; p is 1 with less than two groups, or where all answers are alike.
[[nodiscard]] Homogeneity equal_proportions(std::span<const Count> groups,
                                            const HomogeneityOptions& options = {});

}  // namespace kerf::psychophysics

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kerf/population/compare.h>

namespace kerf::population {

/// The error of a law on a recording that it was not fitted to.
struct HeldOutError {
  std::string recording;
  std::optional<std::string> specimen;  ///< nothing: not known which
  double error = 0.0;  ///< of any unit; not finite: the law failed there, left out and counted
};

/// Mean of held-out errors over recordings and specimens, with its spreads: `estimate_group` of them as they
/// are, with no interval below zero: that an error is not.
[[nodiscard]] GroupEstimate summarise(std::span<const HeldOutError> errors, const GroupOptions& options = {});

/// The errors of two laws on the same recordings, each named once.
struct LawPair {
  std::vector<HeldOutError> first;
  std::vector<HeldOutError> second;
};

/// Which law is better where it was not fitted: differences of errors (first less second) paired by
/// recording, as a group; the test exchanges the laws in a whole specimen (in a recording, where specimens
/// are not known). A negative difference speaks for the first. A recording that only one law was tried on, or
/// failed on, is left out and counted. Folds share what they were fitted to, so that the level is
/// approximate.
[[nodiscard]] std::vector<Comparison> better(std::span<const LawPair> pairs,
                                             const CompareOptions& options = {});

}  // namespace kerf::population

#pragma once

#include <cstddef>
#include <cstdint>

#include "observers/sensation.h"
#include "protocol/judgement.h"

namespace kerf::bench {

/// Who takes part in a simulated experiment.
struct Participants {
  Observer observer;
  std::size_t subjects = 1;
  std::size_t visits = 1;  ///< sessions of each
  /// There is nothing to find, so that what a test finds is a false alarm: nobody feels a difference; where
  /// tastes differ (preference_spread), their mean is none.
  bool nothing_to_find = false;
};

/// A seed of its own for every experiment of a kind, so that they can be drawn in any order (splitmix64).
[[nodiscard]] std::uint64_t experiment_seed(std::uint64_t seed, std::uint64_t kind,
                                            std::uint64_t index) noexcept;

/// One experiment: every subject goes through a session of the protocol, from its plan on, answer by answer.
[[nodiscard]] Study simulated_study(const Protocol& protocol, const Sensation& sensation,
                                    const Participants& participants, std::uint64_t seed);

}  // namespace kerf::bench

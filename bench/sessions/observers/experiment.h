#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

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
  /// Whose share of right catch trials is smaller is left out, as the registered rule has it.
  std::optional<double> catch_right;
};

/// What became of the trials of an experiment, practice included.
struct TrialsGiven {
  std::size_t given = 0;
  std::size_t slipped = 0;     ///< void: taken back
  std::size_t unexplored = 0;  ///< void: not felt as asked
  std::size_t again = 0;       ///< of the void ones, those that came again
  std::size_t lost = 0;        ///< and those that had come as often as they may, and were left out
};

/// A seed of its own for every experiment of a kind, so that they can be drawn in any order (splitmix64).
[[nodiscard]] std::uint64_t experiment_seed(std::uint64_t seed, std::uint64_t kind,
                                            std::uint64_t index) noexcept;

/// One experiment: every subject goes through a session of the protocol, from its plan on, answer by answer.
/// A trial that is taken back or not explored is void and comes again as in a session. `given`, if there is
/// one, is told what became of the trials.
[[nodiscard]] Study simulated_study(const Protocol& protocol, const Sensation& sensation,
                                    const Participants& participants, std::uint64_t seed,
                                    TrialsGiven* given = nullptr);

}  // namespace kerf::bench

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace kerf::bench {

struct Protocol;

/// [catch] of a protocol: now and then a trial whose right answer nobody can miss who attends. It looks like
/// any other to the subject, is in no test and follows no rule; docs/sessions.md.
struct CatchTrials {
  std::size_t every = 0;              ///< one in each so many trials that count; 0: there are none
  std::optional<std::size_t> sample;  ///< of designs without levels: one that is compared in no other trial
  /// Where the question has a direction: the sample has more of what is asked for than any other, so that it
  /// is right; otherwise less, so that the other one is.
  bool is_more = false;
  double level = std::numeric_limits<double>::quiet_NaN();  ///< of designs with levels: of the comparison
};

/// The question asks for the one with more of something, or for the better one: "which is stiffer?".
[[nodiscard]] bool asks_for_more(const Protocol& protocol) noexcept;

/// What catch trials of a tissue compare; the second is the one that is right, where one of the two is.
[[nodiscard]] std::vector<std::array<std::size_t, 2>> catch_pairs_of(const Protocol& protocol,
                                                                     std::size_t tissue);

/// Right answers of all catch trials that are not void.
struct CatchTally {
  std::size_t right = 0;
  std::size_t trials = 0;

  /// Fewer are right than this share of them; of none nobody can say so.
  [[nodiscard]] bool is_below(double least_share) const noexcept {
    return static_cast<double>(right) < least_share * static_cast<double>(trials) - 1e-9;
  }
};

}  // namespace kerf::bench

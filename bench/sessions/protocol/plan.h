#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/protocol.h"

namespace kerf::bench {

inline constexpr std::size_t max_slots = 3;
/// Trials of an adaptive design within which the ways of filling the slots are even.
inline constexpr std::size_t block_of_slots = 10;

/// One trial, with what the subject must not know.
struct TrialPlan {
  std::size_t tissue = 0;
  std::array<std::size_t, 2> pair{};            ///< samples: the standard (or first) and the other
  std::array<std::uint8_t, max_slots> slots{};  ///< which of the pair each slot plays
  double level =
      std::numeric_limits<double>::quiet_NaN();  ///< of the comparison; NaN: none, or not chosen yet
  bool practice = false;
  /// Its answer nobody can miss who attends: in no test, and no rule follows it (attention/catch_trials.h).
  bool is_catch = false;
  std::size_t track =
      0;  ///< of interleaved staircases: whose turn it is; one that has ended leaves it to the next

  /// The answer that is right: a slot; 1 where the two are different, or the signal is there. Of a preference
  /// the slot that plays pair[1].
  [[nodiscard]] std::size_t right(const Protocol& protocol) const noexcept;
};

/// The ways in which the slots can play a pair, in an order that is dealt from like cards: whatever is
/// balanced over all of them differs from one to the next, so that a part of them is balanced too.
[[nodiscard]] std::vector<std::array<std::uint8_t, max_slots>> arrangements_of(const Protocol& protocol);

/// The trials of one subject in their order, practice first. Of adaptive designs as many as there may be.
using Plan = std::vector<TrialPlan>;

/// The plans of all subjects of a study, all from the seed (psychophysics/balance.h):
/// - the trials of a tissue are together, and the orders of the tissues counterbalanced over the subjects;
/// - within a tissue they come in rounds of every pair (every level) once, shuffled;
/// - which sample is in which slot, what X is, which slot holds the signal: each equally often for each
/// subject
///   and pair (level), within one, shuffled; what an odd number leaves over is dealt evenly over the subjects
///   and pairs. docs/sessions-protocol.md says where two such claims cannot both hold;
/// - adaptive designs are even in every ten trials, for they may end anywhere;
/// - interleaved staircases take turns by chance, each equally often in every four rounds of them;
/// - practice is of the subject's first tissue, by chance;
/// - catch trials, where the protocol has any, come between (attention/catch_plan.h).
/// @throws std::invalid_argument: no subject, or more than 1,000.
[[nodiscard]] std::vector<Plan> make_plans(const Protocol& protocol, std::size_t subjects,
                                           std::uint64_t seed);

/// A plan as JSON, for the sealed part of a session, and back.
[[nodiscard]] std::string to_json_text(const Plan& plan);
[[nodiscard]] Plan plan_from_json(std::string_view text);

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// Why a trial does not count.
enum class VoidReason : std::uint8_t {
  fault,            ///< of law, device or loop while a slot played
  soft_start,       ///< the loop faded in anew while a slot played
  limited_ticks,    ///< the device's limits cut the force in too many ticks
  missed_deadline,  ///< too many ticks came late
  unexplored,       ///< a slot was not felt as the protocol asks
  slipped,          ///< the subject took it back before the answer
  off_target,       ///< the tool was too far from the guide's target
};
inline constexpr std::size_t void_reasons = 7;
[[nodiscard]] std::string_view name_of(VoidReason reason) noexcept;  ///< as files say it: "soft-start"
/// "fault soft-start", and back. @throws std::invalid_argument: a word that is no reason.
[[nodiscard]] std::string joined(const std::vector<VoidReason>& reasons);
[[nodiscard]] std::vector<VoidReason> void_reasons_in(std::string_view words);

/// What a subject has to do in each slot of a trial before its answer counts; 0: nothing.
struct Exploration {
  double contact_s = 0.0;  ///< with a force that can be felt
  double travel_m = 0.0;   ///< of the points where forces act
  double force_n = 0.0;    ///< once, at least
  std::size_t strokes = 0;

  [[nodiscard]] bool is_asked() const noexcept {
    return contact_s > 0.0 || travel_m > 0.0 || force_n > 0.0 || strokes > 0;
  }
};

/// What becomes of the states of laws from slot to slot.
enum class StatesBetween : std::uint8_t {
  run_on,          ///< every law knows the whole way of the tool, whichever is felt
  reset,           ///< at each switch all laws begin anew, in a tick of zero force
  out_of_contact,  ///< likewise, and the force stays zero until the tool touches none of them
};

/// When a trial begins.
enum class TrialStart : std::uint8_t { at_once, key, out_of_contact };

/// When practice is over before its last trial: as soon as so many of the last so many answers were right.
struct PracticeCriterion {
  std::size_t right = 0;  ///< 0: there is none
  std::size_t of = 0;
  bool ends_session = false;  ///< where it was not reached; otherwise the session goes on
};

/// [trial] of a protocol: when an answered trial counts. Without any of it every one does.
struct TrialRules {
  bool fault = false;
  bool soft_start = false;
  std::optional<std::size_t> limited_ticks;     ///< in a trial, that still count
  std::optional<std::size_t> missed_deadlines;  ///< likewise
  Exploration explore;
  /// Root mean square of the distance to the guide's target, in a slot [unit of the laws' axis]; above it a
  /// trial is void.
  std::optional<double> off_target;
  bool slip = false;        ///< a subject may take a trial back
  std::size_t repeats = 2;  ///< of one trial, at most
  StatesBetween states = StatesBetween::run_on;
  TrialStart start = TrialStart::at_once;
  PracticeCriterion practice_until;
  double pause_s = 0.0;  ///< without force ahead of each trial

  /// Some trial may come again.
  [[nodiscard]] bool may_void() const noexcept;
};

}  // namespace kerf::bench

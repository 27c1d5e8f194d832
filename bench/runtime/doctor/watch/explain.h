#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doctor/watch/history.h"
#include "doctor/watch/late_wakes.h"

namespace kerf::bench::doctor {

/// What was seen to have made a thread late.
enum class WakeCause : std::uint8_t {
  page_fault,
  throttled,
  process,
  steal,
  stood_still,
  interrupts,
  unknown
};
inline constexpr std::array<const char*, 7> wake_cause_names{"page_fault",  "throttled",  "process", "steal",
                                                             "stood_still", "interrupts", "unknown"};

/// What was seen around one late wake-up.
struct WakeEvidence {
  double window_us = 0.0;  ///< between the counts before and after it
  std::vector<Task> ran;   ///< on the loop's processor between the scans around it, the most first
  double throttled_times = 0.0;
  double steal_us = 0.0;
  std::string interrupt;             ///< the one that came most often beyond what it does over the run
  double more_interrupts = 0.0;      ///< so often, all but the timer's
  double interrupts_expected = 0.0;  ///< by the mean over the run
  bool others_stood_still = false;   ///< a thread on another processor was as late at the same time
};

/// Gathers it. `witness`: the late wake-ups of a thread on another processor.
[[nodiscard]] WakeEvidence evidence_for(const LateWake& wake, const History& history,
                                        std::span<const LateWake> witness);

/// A late wake-up with what it was found to come from.
struct ExplainedWake {
  LateWake wake;
  WakeCause cause = WakeCause::unknown;
  std::string by;        ///< in words: who, and how much of it was seen
  std::int64_t pid = 0;  ///< of a process; 0: it was none
};

/// What the evidence says, the surest first:
///
///  1. page_fault: the thread itself had a page read from a disk;
///  2. of a thread that could have run for at least half of its lateness and had to wait for the processor:
///     throttled, if its control group was held back meanwhile; process, if somebody ran on its processor
///     for at least half of that wait: one that is more urgent, else who ran most;
///  3. of any other, that was not woken in time: steal, if the hypervisor told of at least half of the
///     lateness (which it does in clock ticks); stood_still, if a thread on another processor was late by
///     half as much at the same time, as at a system management interrupt or a pause of the whole virtual
///     machine; interrupts, if there were at least so many more than usual that each had to take 10 us;
///  4. unknown: what was seen explains less than half of it.
[[nodiscard]] ExplainedWake explain(const LateWake& wake, const WakeEvidence& evidence);

/// All of them.
[[nodiscard]] std::vector<ExplainedWake> explain_all(std::span<const LateWake> wakes, const History& history,
                                                     std::span<const LateWake> witness);

}  // namespace kerf::bench::doctor

#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "run/run.h"

namespace kerf::bench {

/// Of its deadlines a loop may miss so large a share and hold its rate (libfranka's communication test warns
/// below a success rate of 0.90 to 0.95).
inline constexpr double most_missed_share = 0.01;

/// Whether a law held its rate in closed loop, in words.
struct Verdict {
  bool passed = true;
  bool felt = true;                  ///< the law pushed at all: else nothing was shown of it
  std::set<Cause> causes;            ///< of what failed
  std::vector<std::string> reasons;  ///< what failed, or what was found worth saying
};

/// Judges a run, and keeps apart what the law does and what the machine does.
///
/// The law fails if 99.9 % of the measured ticks do not compute within half of the periods that they step
/// over, in processor time: time in which the thread was made to wait does not count against it. The run
/// fails if more than most_missed_share of the deadlines were missed; each miss is charged to law, device or
/// machine by its own evidence (cause_of()), and who cost most of them is to blame. It fails on any fault of
/// law or device. Missed deadlines are set beside those of an empty loop on this machine, if the floor is
/// known. Energy given to the hand is told and does not fail: a held spring always gives some.
[[nodiscard]] Verdict judge(const RunResult& result);

/// The same of a law that was run to be felt: one that never pushed has not passed, whatever held.
[[nodiscard]] Verdict judge_law(const RunResult& result);

/// A verdict of which nothing can be said, since the law never pushed.
inline constexpr std::string_view not_felt = "not known";
/// "pass", "fail", or not_felt.
[[nodiscard]] std::string_view name_of(const Verdict& verdict);

/// What the device counted, by name: value and unit.
[[nodiscard]] nlohmann::ordered_json figures_as_json(const std::vector<drivers::Figure>& figures);

/// The JSON of `kerf check`.
[[nodiscard]] nlohmann::ordered_json check_as_json(const RunResult& result, const Verdict& verdict);

}  // namespace kerf::bench

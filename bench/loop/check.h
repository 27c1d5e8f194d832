#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "loop/run.h"

namespace kerf::bench {

/// Whether a law held its rate in closed loop, in words.
struct Verdict {
  bool passed = true;
  std::vector<std::string> reasons;  ///< what failed, or what was found worth saying
};

/// Judges a run, keeping the law's own time apart from the machine's lateness.
///
/// Fails if 99.9 % of the ticks do not compute within half the period (the law is too slow), if more than 1 %
/// of the deadlines were missed (after libfranka's communication test, which asks for a success rate of 0.99
/// too), or on any fault. Energy given to the hand is told and does not fail: a held spring always gives
/// some.
[[nodiscard]] Verdict judge(const RunResult& result);

/// The JSON of `kerf check`.
[[nodiscard]] nlohmann::ordered_json check_as_json(const RunResult& result, const Verdict& verdict);

}  // namespace kerf::bench

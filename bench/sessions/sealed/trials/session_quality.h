#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "sealed/trials/trial_counts.h"

namespace kerf::bench {

/// How the trials of a session went, practice included, for who looks after it while it is under way: sums
/// over all of them, of no sample, slot, level or answer.
struct SessionQuality {
  TrialCounts counts;
  std::size_t unknown = 0;  ///< trials without a trace
  std::size_t unfelt = 0;   ///< a slot had no force that can be felt
  std::size_t faulty = 0;   ///< a fault of law, device or loop while a slot played
  std::uint64_t late_ticks = 0;
  std::uint64_t limited_ticks = 0;
  /// Of the time in which a slot played, that with a force that can be felt. With catch trials, whose sample
  /// may have none, only of a session that is finished, for the same reason as `catches`.
  double contact_share = std::numeric_limits<double>::quiet_NaN();
  /// Right answers of catch trials; only of a session that is finished, since while it runs a count that
  /// goes up would tell which trial was one.
  std::optional<CatchTally> catches;
  double median_response_s = std::numeric_limits<double>::quiet_NaN();  ///< of answered trials
  double slowest_response_s = std::numeric_limits<double>::quiet_NaN();
};

[[nodiscard]] SessionQuality session_quality(const SessionStore& session);

/// "5 trials answered, 4 count, 1 void (fault 1); 0 unfelt, 1 faulty, 3 late ticks, ..."
[[nodiscard]] std::string in_words(const SessionQuality& quality);
[[nodiscard]] nlohmann::ordered_json to_json(const SessionQuality& quality);

}  // namespace kerf::bench

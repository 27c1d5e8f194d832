#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "host/histogram.h"

namespace kerf::bench {

/// What the machine itself does to a loop that does nothing: the least that can be asked of one that works.
struct HostFloor {
  double rate_hz = 1000.0;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;  ///< deadlines that an empty loop missed
  Percentiles sleep;         ///< lateness of a thread that only sleeps
  Percentiles wake;          ///< lateness of the loop, which sleeps and then spins
  std::int64_t spin_ns = 0;  ///< how long before a deadline the loop wakes up to spin
  std::string measured;      ///< when: ISO 8601, UTC
  bool from_cache = false;

  /// So many missed deadlines of `ticks` may be the machine's own: the upper 95 % bound of its rate, and
  /// three standard deviations of the count.
  [[nodiscard]] double max_expected(std::uint64_t ticks) const;
};

[[nodiscard]] nlohmann::ordered_json to_json(const HostFloor& floor);

/// How long before a deadline a loop on this thread has to wake up so that 99 of 100 times it is awake in
/// time: a fifth more than the 99th percentile of 200 sleeps' lateness, from 10 us to half a period. Takes
/// 0.1 s.
[[nodiscard]] std::int64_t learn_spin_ns(std::int64_t period_ns);

/// Runs an empty loop at a rate for so many seconds on a thread with every real-time measure that is
/// permitted.
[[nodiscard]] HostFloor measure_host_floor(double rate_hz, double seconds);

/// The floor as it was measured since the machine was started, by this user and with these rights; nothing if
/// there is none. Kept in $XDG_CACHE_HOME/kerf, or ~/.cache/kerf.
[[nodiscard]] std::optional<HostFloor> cached_host_floor(double rate_hz);

/// The cached floor, or one measured now over so many seconds and kept, always so if it is wanted anew. A
/// cache that cannot be written is done without.
[[nodiscard]] HostFloor host_floor(double rate_hz, double seconds, bool anew = false);

}  // namespace kerf::bench

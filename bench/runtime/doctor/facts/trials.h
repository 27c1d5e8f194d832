#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "host/histogram.h"

namespace kerf::bench::doctor {

/// What was tried on this machine, each on a thread of its own on the loop's processor, which ends with it.
struct MachineTrials {
  double clock_read_us = 0.0;        ///< one reading of the monotonic clock, at the median
  double work_us = 0.0;              ///< a computation right after another one, at the median
  double work_after_sleep_us = 0.0;  ///< the same after a millisecond of sleep
  std::int64_t slack_ns = 0;         ///< of the timers of this process

  // Lateness of a thread that only sleeps:
  Percentiles with_slack;     ///< as a thread is that asks for nothing
  Percentiles without_slack;  ///< that asked for a slack of 1 ns
  bool may_be_realtime = false;
  std::string realtime_detail;          ///< what it obtained, or why not
  std::optional<Percentiles> realtime;  ///< at SCHED_FIFO; none: refused
  bool may_stay_awake = false;
  std::string awake_detail;
  std::optional<Percentiles> awake;  ///< as `realtime`, or `without_slack`, with deep sleep states held off
};

/// Tries each; takes about a second with 200 sleeps of half a millisecond.
[[nodiscard]] MachineTrials run_trials(int sleeps = 200);

/// Whether SCHED_FIFO can be taken, tried on a thread that ends at once, and in words what came of it.
struct RealtimeTrial {
  bool obtained = false;
  std::string detail;
};
[[nodiscard]] RealtimeTrial try_realtime();

}  // namespace kerf::bench::doctor

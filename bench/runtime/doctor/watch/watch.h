#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <kerf/drivers/device.h>

#include "doctor/facts/host_tree.h"
#include "doctor/watch/explain.h"
#include "host/histogram.h"
#include "host/realtime.h"
#include "loop/loop.h"

namespace kerf::bench::doctor {

struct WatchOptions {
  double rate_hz = 1000.0;
  double seconds = 30.0;
};

/// A thread that only sleeps to absolute times, as that of cyclictest does.
struct Sleeper {
  Histogram wake;
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;  ///< periods in which it was not woken
};

/// What became of a loop and what was seen beside it.
struct Watched {
  int processor = -1;
  double rate_hz = 0.0;
  double late_us = 0.0;  ///< from which lateness on a wake-up was looked into
  std::int64_t spin_ns = 0;
  LoopReport loop;
  ThreadUsage usage;       ///< of the loop's thread
  double cpu_share = 0.0;  ///< of a processor that it used
  Sleeper sleeper;
  std::size_t late_wakes = 0;  ///< of both, those that were not kept included
  std::vector<ExplainedWake> explained;
  History history;
  std::vector<RealtimeMeasure> measures;  ///< that the loop obtained
};

/// Runs the loop with a device and no force, by the wall clock and with every real-time measure that is
/// permitted; beside it, on the same processor, half a period later and more urgent, a sleeper; and on
/// another processor a witness and the observer. A loop that misses nothing and a sleeper that does tell that
/// spinning helps; both late at once, that it cannot.
///
/// `done` counts deadlines. `stop` ends it early: what was seen so far is returned.
[[nodiscard]] Watched watch(const HostTree& tree, drivers::Device& device, const WatchOptions& options,
                            const std::atomic<bool>& stop, std::atomic<std::size_t>& done);

}  // namespace kerf::bench::doctor

#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

#include "run/run.h"
#include "sealed/session_store.h"
#include "session/director.h"
#include "subject/subject.h"

namespace kerf::bench {

struct SessionRunOptions {
  /// Device, sensor, rate and ramp; law, scene, recording and duration are the session's own affair.
  RunOptions loop;
  std::function<void(const drivers::Sample&)> each_sample;  ///< in the tick: for the buttons of a device
  std::function<void(std::size_t answered, std::size_t at_most)> progress;
};

struct SessionRunResult {
  SessionEnd end = SessionEnd::none;
  std::size_t answered = 0;  ///< in all runs
  std::size_t at_most = 0;
  RunResult run;
};

/// Runs a session on a device until it is finished, left or `stop` is set. By the wall clock the subject is
/// asked by a thread of its own, every 5 ms; in virtual time in every tick. The loop records nothing itself:
/// what it would write tells the laws apart.
/// @throws drivers::DeviceError (answers so far are kept, and the session can be gone on with),
///         std::invalid_argument, std::system_error.
[[nodiscard]] SessionRunResult run_session(SessionStore& store, Subject& subject,
                                           const SessionRunOptions& options, const std::atomic<bool>& stop);

}  // namespace kerf::bench

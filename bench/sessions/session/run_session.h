#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "run/run.h"
#include "sealed/session_store.h"
#include "session/director.h"
#include "session/live_guide.h"
#include "subject/subject.h"

namespace kerf::bench {

struct SessionRunOptions {
  /// Device, sensor, rate and ramp; law, scene, recording and duration are the session's own affair.
  RunOptions loop;
  std::function<void(const drivers::Sample&)> each_sample;  ///< in the tick: for the buttons of a device
  /// Where guide and tool are, for who shows them; has to outlive the run.
  LiveGuide* live_guide = nullptr;
  std::function<void(std::size_t answered, std::size_t at_most)> progress;
  /// What the experimenter wrote since it was asked last, a line at a time; kept with its time.
  std::function<std::optional<std::string>()> notes;
  std::function<void()> noted;  ///< told of every note that was kept
  /// Director::Options::recorded; by the wall clock not in the tick.
  std::function<void(const RecordedTrial& trial, bool is_left_out)> recorded;
};

struct SessionRunResult {
  SessionEnd end = SessionEnd::none;
  std::size_t answered = 0;  ///< in all runs
  std::size_t at_most = 0;
  RunResult run;
};

/// The last screen of a session that ends ahead of its time: stopped by whoever runs it, or without its
/// device.
[[nodiscard]] SubjectView stopped_view(const Protocol& protocol);

/// Runs a session on a device until it is finished, left or `stop` is set. By the wall clock the subject is
/// asked by a thread of its own, every 5 ms; in virtual time in every tick. The loop records nothing itself:
/// what it would write tells the laws apart. However it ends, the subject is shown that it has.
/// @throws drivers::DeviceError (answers so far are kept, and the session can be gone on with),
///         std::invalid_argument, std::system_error.
[[nodiscard]] SessionRunResult run_session(SessionStore& store, Subject& subject,
                                           const SessionRunOptions& options, const std::atomic<bool>& stop);

}  // namespace kerf::bench

#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "fits/fit_recording.h"
#include "replay/open_loop.h"
#include "replay/path.h"
#include "replay/path_rendering.h"
#include "run/run.h"

namespace kerf::bench {

struct ThroughOptions {
  bool bridge = false;
  double speed = 1.0;
  OpenLoopOptions open_loop;
};

/// A recording's motion through laws.
struct ThroughReplay {
  Source source;  ///< as it was played
  OpenLoopResult result;
  std::vector<std::string> notes;  ///< what the reader of the figures should know of the recording
};

[[nodiscard]] ThroughReplay replay_through(Source source, const std::vector<NamedLaw>& laws,
                                           const ThroughOptions& options, const std::atomic<bool>& stop);

/// Each law on each of its axes in a line, with its events and how exact it was.
[[nodiscard]] std::vector<std::string> through_lines(const ThroughReplay& replay);

/// The JSON of the table that recorded forces are rendered from.
[[nodiscard]] nlohmann::ordered_json table_as_json(const FittedLaw& table, std::size_t rows);

struct PathReplayOptions {
  PathOptions path;
  CouplingOptions coupling;
  RunOptions run;  ///< its rendering is set here
};

/// A device that was held to a recording's positions.
struct PathReplay {
  Path path;
  PathReport report;
  RunResult run;
};

/// Plays the path until it ends, unless `options.run.seconds` is over before.
/// @throws as make_path(), couplings() and run_on_device() do.
[[nodiscard]] PathReplay replay_path(const Source& source, const PathReplayOptions& options,
                                     const std::atomic<bool>& stop);

/// How far off its path the device was, an axis a line.
[[nodiscard]] std::vector<std::string> path_lines(const PathReplay& replay);

}  // namespace kerf::bench

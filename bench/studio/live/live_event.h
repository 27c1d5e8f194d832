#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "live/live_loop.h"

namespace kerf::bench {

/// How far one viewer is.
struct LiveCursor {
  std::uint64_t tick = 0;              ///< where the next frame begins
  std::uint64_t calls = 0;             ///< of live_event()
  std::uint64_t ticks_per_column = 1;  ///< as wide as a pixel of the viewer
  std::uint64_t run = 0;               ///< whose ticks these are
};

/// Counts a call, and whether it is one that tells the status: every 15th, the first included.
[[nodiscard]] inline bool is_status_due(LiveCursor& cursor) noexcept { return cursor.calls++ % 15 == 0; }

/// The next server-sent event for one viewer, made to be asked for 60 times a second: a frame of at most 600
/// columns, or where is_status_due() the status; empty if there is nothing new. A viewer
/// begins with what the history has; one that lags more than that skips ahead; a new loop begins at its first
/// tick.
///
///     event: frame
///     data: {"run":1,"from":120,"ticks":2,"period_s":0.001,"smallest":[[..],..],"largest":[[..],..],
///            "events":[{"time_s":0.12,"kind":"law","text":"kelvin"}]}
///
///     event: status
///     data: as status_as_json()
///
/// Numbers have 6 significant digits; where a column has none it says null.
[[nodiscard]] std::string live_event(const LiveLoop& loop, LiveCursor& cursor);

[[nodiscard]] std::string status_event(const nlohmann::ordered_json& status);

/// A frame as JSON, of `traces` traces; in one line.
[[nodiscard]] std::string to_json(const LiveFrame& frame, std::size_t traces, std::uint64_t run,
                                  double period_s);

/// Durations in seconds.
[[nodiscard]] nlohmann::ordered_json status_as_json(const LiveStatus& status);
/// Of a loop that nothing is told of, because a session runs, but whether zero force is held.
[[nodiscard]] nlohmann::ordered_json session_status_as_json(bool is_released);
[[nodiscard]] nlohmann::ordered_json traces_as_json(const std::vector<Trace>& traces);

}  // namespace kerf::bench

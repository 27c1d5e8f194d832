#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "http/routes.h"
#include "laws/law_file.h"
#include "live/live_loop.h"
#include "scene/scene.h"

namespace kerf::bench {

/// What the routes of a running loop ask of the rest of the program. Those that look things up throw
/// RequestError.
struct LiveHooks {
  std::function<std::string(const std::string& uri)> uri_of;  ///< to open, for the one that a page has sent
  std::function<LawFile(const std::string& id)> law_of;
  std::function<std::string(const std::string& id)> law_name_of;  ///< for people; empty: the id
  std::function<Scene(const std::string& id)> scene_of;
  std::function<std::filesystem::path(const std::string& name)> new_recording;
  std::function<bool()> is_closed;  ///< a session is running: nothing of the loop may be shown
};

/// The running loop over HTTP. `loop` and what the hooks use have to outlive the routes and the server.
///
///     GET  /api/live/status                            as status_as_json(); "session": true and nothing else
///                                                      of the loop while a session runs
///     GET  /api/live/traces                            [{"name", "unit", "group"}] of the last loop
///     GET  /api/live/stream?ticks=N                    server-sent events, as live_event(): N ticks a column
///     GET  /api/live/view?traces=0,3&from=S&to=S&columns=N   bytes_of() a TraceView
///     POST /api/live/start    {"device", "sensor", "scene_id"}; what is left out or empty is the usual
///     POST /api/live/stop     {}
///     POST /api/live/feel     {"law": ID} or {"toml": TEXT} or {}: nothing
///     POST /api/live/zero     anything, also while a session runs or no loop does
///     POST /api/live/resume   {}
///     POST /api/live/confirm  {}: the tool is where it seems to be after a jump of the position
///     POST /api/live/dismiss  {}: the fault that ended the last loop has been read
///     POST /api/live/mark     {"text"}: an event "mark" of this moment, also in the recording
///     POST /api/live/record   {"name"}
///     POST /api/live/record/stop   {}
///
/// A POST answers with the status. While a session runs all but zero and status answer 409.
void add_live_routes(Routes& routes, LiveLoop& loop, const LiveHooks& hooks);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "http/routes.h"
#include "server/session_host.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// What the routes of sessions ask of the rest of the program.
struct SessionHooks {
  std::filesystem::path key_file;                             ///< of whoever keeps the blinding; empty: none
  std::function<std::string(const std::string& uri)> uri_of;  ///< to open, for the one that a page has sent
  /// SessionHost::start()'s: whatever else moves the device has to end, and its forces are shown to nobody.
  std::function<void()> prepare;
};

/// The experimenter's page.
///
///     GET  /api/session         how far it is
///     POST /api/session/start   {"session": ID, "device", "sensor", "passphrase", "check"}
///     POST /api/session/stop
///
void add_session_routes(Routes& routes, Workspace& workspace, SessionHost& host, const SessionHooks& hooks);

}  // namespace kerf::bench

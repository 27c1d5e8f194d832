#pragma once

#include <functional>

#include "http/routes.h"
#include "server/session_host.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// The experimenter's page.
///
///     GET  /api/session         how far it is
///     POST /api/session/start   {"session": ID, "device", "sensor", "passphrase", "check"}
///     POST /api/session/stop
///
/// `prepare` is SessionHost::start()'s: whatever else moves the device has to end, and its forces are shown
/// to nobody.
void add_session_routes(Routes& routes, Workspace& workspace, SessionHost& host,
                        std::filesystem::path key_file, std::function<void()> prepare);

}  // namespace kerf::bench

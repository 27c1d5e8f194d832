#pragma once

#include "http/routes.h"
#include "workspace/workspace.h"

namespace kerf::bench {

// A law for another program, as `kerf export` writes it, over HTTP.
//
//     GET /api/laws/hosts                     [{"name": "fmu", "what": "FMI 3.0 Co-Simulation for Linux"},
//     ...] GET /api/law/exported?id=ID&host=fmu    its file, or a zip of its files; the same law, the same
//     bytes
//
/// @throws RequestError 400 with the reason for a host that is none, and a law that it cannot carry.
[[nodiscard]] HttpResponse exported_law(const HttpRequest& request, Workspace& workspace);
[[nodiscard]] HttpResponse hosts_list();

}  // namespace kerf::bench

#pragma once

#include "http/routes.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// Protocols of experiments, written in the page as text and tried as the program reads them.
///
///     GET  /api/protocol?id=ID     {"name", "text"}
///     POST /api/protocol/check     {"text"}, of one in a folder of its own "id": {"problem", "design",
///     "samples", "trials", ...};
///                                  "problem" is empty where 'kerf session new' would take it
///     POST /api/protocol           {"text", "name"} for a new NAME.protocol.toml of the folder, or {"text",
///     "id"} to
///                                  replace that one: {"id", "name"}; 400 with the problem
///
/// Laws, recordings, texts and scenes that a protocol names lie in the studio's folder; plugins, which would
/// run here, are taken at a terminal alone.
void add_protocol_routes(Routes& routes, Workspace& workspace);

}  // namespace kerf::bench

#pragma once

#include "http/routes.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// What is done to the files themselves. A recording that is being written stays as it is. The workspace must
/// outlive the routes.
///
///     POST /api/files/delete    {"id", "kind": "recording" or "law"}: {"key"} in the trash
///     POST /api/files/rename    {"id", "kind", "name"}: {"id"}; the ending stays
///     POST /api/files/annotate  {"id", "text", "time_s"?}: a line in the recording's history, and with a
///                               time an event of the kind "note"
///     GET  /api/trash           [{"key", "name", "time", "bytes"}], newest first
///     POST /api/trash/restore   {"key"}
///     POST /api/trash/empty
void add_file_routes(Routes& routes, Workspace& workspace);

}  // namespace kerf::bench

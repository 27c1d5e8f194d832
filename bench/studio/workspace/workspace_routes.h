#pragma once

#include <string>

#include "http/routes.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// GET /api/workspace: everything in the folder that the studio knows what to do with. `device` is offered
/// where one is asked for.
void add_workspace_routes(Routes& routes, Workspace& workspace, const std::string& device);

}  // namespace kerf::bench

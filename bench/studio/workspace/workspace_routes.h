#pragma once

#include <string>

#include "http/routes.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// GET /api/workspace: everything in the folder that the studio knows what to do with. `device` is offered
/// where one is asked for. `state` names what is there; asked with `unless` of that name, the answer is
/// {"unchanged": true} as long as it is so.
void add_workspace_routes(Routes& routes, Workspace& workspace, const std::string& device);

}  // namespace kerf::bench

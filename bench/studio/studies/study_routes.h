#pragma once

#include "http/routes.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// What the pages of studies ask for; both must outlive the routes.
///
///     GET /api/studies               study_entry() of each study in the folder
///     GET /api/study?id=             study_view()
///     GET /api/study/drawn?id=&name= a recording of it, drawn as in its report: chart_to_json()
///     GET /api/study/report?id=      its report.html, as a document that runs nothing and loads nothing
///     GET /api/study/table?id=&name= one of its tables
///
/// Nothing is computed here: `kerf study run` does that.
void add_study_routes(Routes& routes, Workspace& workspace);

}  // namespace kerf::bench

#pragma once

#include "http/routes.h"
#include "jobs/jobs.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// What the pages for fits, charts, choices and stability ask for: orders for jobs, their
/// results as they were written, laws, and what laws leave of recordings. All three must outlive the routes.
///
///     POST /api/fit          {recording, axis, models, folds}
///     POST /api/chart        {recording, axis, models}
///     POST /api/choose       {recording, axis, rate_hz?, most_segments?}
///     POST /api/stability    {device, axis?, rate_hz, grip?, law?, depth_m?, speed_m_s?, cells}
///     GET  /api/result?id=   fit.json, chart.json, choose.json, stability.json or identify.json as it
///     stands; of a chart and a map
///                            stands "figure" beside it, chart_to_json() of its picture
///     GET  /api/law?id=      law_as_json()
///     GET  /api/laws/fitted  the laws of the registry that can be fitted, with their equations
///     GET  /api/residuals?id=RECORDING&axis=&law=&columns=    residuals_of()
///
/// Files are named by their ids; devices are simulated ones, since a map asks for mass and friction, which no
/// real device tells, and nothing is to move because a map was asked for.
void add_result_routes(Routes& routes, Workspace& workspace, Jobs& jobs);

}  // namespace kerf::bench

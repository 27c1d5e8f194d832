#pragma once

#include <filesystem>

#include "http/routes.h"
#include "jobs/jobs.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// Files of other programs taken into the workspace as recordings, by the code of `kerf import`. Workspace
/// and jobs must outlive the routes.
///
///     GET  /api/import              {"uploads": [{"upload", "name", "bytes", "have", "result"}], "mappings":
///                                   [{"id", "name"}], "largest", "piece"} [bytes]
///     POST /api/import/begin        {name, bytes, modified}: {"upload", "have"}; goes on where it stopped
///     POST /api/import/piece?upload=&at=   the next bytes, at most "piece" of them: {"have"}
///     POST /api/import/forget       {upload}: throws away what has come
///     POST /api/import/preview      {upload, map, options}: preview_as_json()
///     GET  /api/import/mapping?id=  {"map", "options"} of a NAME.import.toml
///     POST /api/import/mapping      {name, map, options, replace?}: saves one: {"id", "name"}
///     POST /api/import/start        {files: [{upload, name, map, options}]}: {"job"}
///     GET  /api/import/result?upload=      import_result()
///
/// Options: {sheet, stretch, rate, resample, velocity_window, origin, point, sensor_rotation, strict} as an
/// import file has them, each of which may be left out. `program` is kerf itself.
void add_intake_routes(Routes& routes, Workspace& workspace, Jobs& jobs, std::filesystem::path program);

}  // namespace kerf::bench

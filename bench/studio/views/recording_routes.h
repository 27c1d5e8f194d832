#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "http/routes.h"
#include "views/recording_views.h"

namespace kerf::bench {

/// Recordings for the page: GET /api/recording, /api/recording/view, /api/recording/loops and
/// /api/recording/inspection. `path_of` gives
/// the file of an id and throws RequestError for one that is not known; `views` has to outlive the routes.
///
/// While a recording is written, /api/recording tells of it as it is now, and the others go on with what was
/// told.
void add_recording_routes(Routes& routes, RecordingViews& views,
                          std::function<std::filesystem::path(const std::string& id)> path_of);

}  // namespace kerf::bench

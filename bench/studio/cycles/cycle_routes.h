#pragma once

#include "http/routes.h"
#include "views/recording_views.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// Cycles of a recording found, mended and kept in it, by the code of `kerf segment`. Both must outlive the
/// routes.
///
///     GET  /api/cycles?id=            cycle_view() of those stored, or of what is found by itself; "author"
///     POST /api/cycles/look           {recording, axis, settings, phases, said, step, loop}: cycle_view() of
///                                     the cycles after the step; nothing is kept
///     GET  /api/cycles/row?id=&time=  {"row", "time_s"}: the first row at or after a time, or the last one
///     POST /api/cycles/save           {recording, version, author, axis, settings, phases, said}: keeps them
///                                     in the recording as an edit with its author, and answers as GET
///     GET  /api/cycles/fit?id=&fit=   {"earlier": true, false, or null where that is not known, "why"}:
///                                     whether a fit.json is of other cycles than the recording has now
///
/// 409 where "version" is not that of the recording any more: somebody else has changed its cycles, or
/// another recording has taken its place. 423 where it cannot be written.
void add_cycle_routes(Routes& routes, Workspace& workspace, RecordingViews& views);

}  // namespace kerf::bench

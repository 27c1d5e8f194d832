#pragma once

#include <functional>

#include "http/routes.h"
#include "laws/law_file.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// What the segment editor asks for, all of it answered slowly; errors are those of segment_editor.h and of
/// reading a recording.
///
///     GET  /api/editor/curve?id=&axis=                          EditorCurve
///     GET  /api/editor/law?id=            Knots of a piecewise law file, with its contact and units
///     POST /api/editor/error   {recording, axis, knots}            LawError
///     POST /api/editor/best    {recording, axis, segments, loop}   {knots, error}
///     POST /api/editor/forces  {recording, axis, knots}            {knots, error}
///     POST /api/editor/save    DrawnLaw: writes NAME.law.toml      {id, name, error}
///     POST /api/editor/feel    {recording, axis, knots}            {}
///
/// The curves of the last few recordings are kept, by id and time of the file. `render` renders a law from
/// now on, or throws RequestError 409 where no loop runs; it is called from the slow thread. The routes live
/// no longer than the workspace.
void add_editor_routes(Routes& routes, Workspace& workspace, std::function<void(const LawFile&)> render);

}  // namespace kerf::bench

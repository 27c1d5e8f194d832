#pragma once

#include "http/routes.h"
#include "verbs/sweep_verb.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// What the page of a sweep asks for; both must outlive the routes.
///
///     GET  /api/sweep?id=      its tables, with their columns and how many cells each has
///     POST /api/sweep/answer   { id, and what question_from_json() takes }: what is known of every part
///     POST /api/sweep/sample   { id, columns, most, ... }: a value of each column of cells taken by chance
///
/// The two that are posted change nothing: a question is too long for an address. Numbers have six digits.
/// @param verbs that sweeps may be of
void add_sweep_routes(Routes& routes, Workspace& workspace, SweepVerbs verbs);

}  // namespace kerf::bench

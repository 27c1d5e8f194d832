#pragma once

#include "program/verb.h"
#include "stability/study.h"

namespace kerf::bench {

/// Adds the walls' range and what decides how the stiffest of them is searched. `study` has to live until the
/// verb has run.
void add_wall_search_options(Verb& verb, StudyOptions& study);

}  // namespace kerf::bench

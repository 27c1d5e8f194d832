#pragma once

#include "cli/app.h"
#include "cli/verb.h"

namespace kerf::bench {

// The verbs of `kerf session`, each in the file cli/verb_session_NAME.cpp.
void add_session_simulate(CLI::App& session, Context& context);

}  // namespace kerf::bench

#pragma once

#include "program/app.h"
#include "program/verb.h"

namespace kerf::bench {

// The verbs of `kerf session`, each in the file cli/verb_session_NAME.cpp.
void add_session_key(CLI::App& session, Context& context);
void add_session_new(CLI::App& session, Context& context);
void add_session_run(CLI::App& session, Context& context);
void add_session_analyze(CLI::App& session, Context& context);
void add_session_open(CLI::App& session, Context& context);
void add_session_share(CLI::App& session, Context& context);
void add_session_plan(CLI::App& session, Context& context);
void add_session_note(CLI::App& session, Context& context);
void add_session_drop(CLI::App& session, Context& context);
void add_session_status(CLI::App& session, Context& context);
void add_session_simulate(CLI::App& session, Context& context);

}  // namespace kerf::bench

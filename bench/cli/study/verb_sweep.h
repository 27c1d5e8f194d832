#pragma once

#include "program/app.h"
#include "program/verb.h"

namespace kerf::bench {

// The verbs of `kerf sweep`, each in the file study/verb_sweep_NAME.cpp; worker stands beside run, status
// beside merge.
void add_sweep_plan(CLI::App& sweep, Context& context);
void add_sweep_run(CLI::App& sweep, Context& context);
void add_sweep_worker(CLI::App& sweep, Context& context);
void add_sweep_status(CLI::App& sweep, Context& context);
void add_sweep_merge(CLI::App& sweep, Context& context);
void add_sweep_submit(CLI::App& sweep, Context& context);

}  // namespace kerf::bench

#pragma once

#include "program/app.h"
#include "program/verb.h"

namespace kerf::bench {

// The verbs of `kerf study`, each in the file study/verb_study_NAME.cpp; report stands beside run.
void add_study_new(CLI::App& study, Context& context);
void add_study_run(CLI::App& study, Context& context);
void add_study_report(CLI::App& study, Context& context);
void add_study_verify(CLI::App& study, Context& context);

}  // namespace kerf::bench

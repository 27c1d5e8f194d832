#pragma once

#include "program/app.h"
#include "program/verb.h"

namespace kerf::bench {

// One function a verb, each in the file GROUP/verb_NAME.cpp.
void add_blade(CLI::App& app, Context& context);
void add_chart(CLI::App& app, Context& context);
void add_check(CLI::App& app, Context& context);
void add_choose(CLI::App& app, Context& context);
void add_compare(CLI::App& app, Context& context);
void add_convert(CLI::App& app, Context& context);
void add_export(CLI::App& app, Context& context);
void add_demo(CLI::App& app, Context& context);
void add_devices(CLI::App& app, Context& context);
void add_doctor(CLI::App& app, Context& context);
void add_fit(CLI::App& app, Context& context);
void add_identify(CLI::App& app, Context& context);
void add_import(CLI::App& app, Context& context);
void add_info(CLI::App& app, Context& context);
void add_inspect(CLI::App& app, Context& context);
void add_law(CLI::App& app, Context& context);
void add_device(CLI::App& app, Context& context);
void add_laws(CLI::App& app, Context& context);
void add_prepare(CLI::App& app, Context& context);
void add_record(CLI::App& app, Context& context);
void add_regress(CLI::App& app, Context& context);
void add_pages(CLI::App& app, Context& context);
void add_repair(CLI::App& app, Context& context);
void add_replay(CLI::App& app, Context& context);
void add_report(CLI::App& app, Context& context);
void add_reproduce(CLI::App& app, Context& context);
void add_segment(CLI::App& app, Context& context);
void add_session(CLI::App& app, Context& context);
void add_stability(CLI::App& app, Context& context);
void add_study(CLI::App& app, Context& context);
void add_sweep(CLI::App& app, Context& context);
void add_studio(CLI::App& app, Context& context);  // with KERF_STUDIO alone
void add_train(CLI::App& app, Context& context);
void add_validate(CLI::App& app, Context& context);

}  // namespace kerf::bench

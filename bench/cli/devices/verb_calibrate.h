#pragma once

#include "program/app.h"
#include "program/verb.h"

namespace kerf::bench {

void add_calibrate(CLI::App& app, Context& context);

}  // namespace kerf::bench

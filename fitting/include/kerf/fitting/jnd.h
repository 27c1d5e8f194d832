#pragma once

#include <kerf/compare/jnd.h>

namespace kerf::fitting {

// What a hand can feel is defined once, where forces are compared.
using compare::felt_lever;
using compare::fingers_m;
using compare::force_jnd;
using compare::Jnd;
using compare::jnd_of;
using compare::jnd_source_of;
using compare::rms_of;
using compare::torque_jnd;

}  // namespace kerf::fitting

#pragma once

#include "fits/asked_fit.h"
#include "program/verb.h"

namespace kerf::bench {

/// Adds --weber, --threshold and --jnd-source.
void add_jnd_options(Verb& verb, AskedJnd& jnd);

}  // namespace kerf::bench

#pragma once

#include "fits/fit_recording.h"
#include "program/app.h"

namespace kerf::bench {

/// The laws compared, the parameters of those with few, and the choice, for people.
void say_fit(const RecordingFit& fit, Context& context);

/// What the data and the laws gave cause to warn of.
void warn_of(const RecordingFit& fit);

}  // namespace kerf::bench

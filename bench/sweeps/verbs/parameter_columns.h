#pragma once

#include <string>

#include "fits/fit_recording.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {

/// The parameters of a law that was fitted, each with its standard error and its interval.
inline void add_parameters(CellNumbers& numbers, const FittedLaw& law) {
  for (const fitting::Estimate& estimate : law.result.parameters) {
    const std::string& name = estimate.info.name;
    const std::string unit =
        models::unit_of(estimate.info.quantity, law.file.force_unit, law.file.position_unit);
    numbers.add(name, unit, estimate.value);
    numbers.add(name + "_std_error", unit, estimate.std_error);
    numbers.add(name + "_lower", unit, estimate.lower);
    numbers.add(name + "_upper", unit, estimate.upper);
  }
}

}  // namespace kerf::bench

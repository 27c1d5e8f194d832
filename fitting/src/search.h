#pragma once

#include <string>
#include <vector>

#include "solve.h"

namespace kerf::fitting {

/// What a law needs before its parameters can be searched: options that follow from the data (range and loop
/// of a table, loop of a piecewise law), and which parameters are free.
[[nodiscard]] Problem make_problem(std::string_view model, const models::Options& given,
                                   const Samples& samples);

/// Finds the best parameters over the masked samples. `near` is a solution to begin at (of other samples), or
/// empty.
[[nodiscard]] Solution search(const Problem& problem, const Samples& samples, const Mask& mask,
                              const std::vector<double>& near);

}  // namespace kerf::fitting

#pragma once

#include "starts/search.h"

namespace kerf::fitting {

[[nodiscard]] Solution solve_fracture(const Problem& problem, const Samples& samples, const Weights& weights,
                                      const Values& near, const RobustLoss& loss);
[[nodiscard]] Solution solve_ruptures(const Problem& problem, const Samples& samples, const Weights& weights);

}  // namespace kerf::fitting

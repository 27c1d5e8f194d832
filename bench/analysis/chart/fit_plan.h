#pragma once

#include <string>
#include <vector>

#include <kerf/models/parameter.h>

namespace kerf::bench {

/// One fit for a chart: a law, in one size or by one integrator.
struct FitPlan {
  std::string model;
  std::string label;  ///< "5 segments", "2 arms"; "as fitted" where there is nothing to choose
  models::Options options;
};

/// The fits of the laws named, "all" for every one. Empty: those that are charted by their facts, which say
/// something of any axis.
/// @throws std::invalid_argument for a law that is unknown or not fitted.
[[nodiscard]] std::vector<FitPlan> fit_plans(const std::vector<std::string>& models);

/// Whether a law can be computed in single precision.
[[nodiscard]] bool has_float(std::string_view model);

}  // namespace kerf::bench

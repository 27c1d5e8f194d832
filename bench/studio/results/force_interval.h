#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "laws/law_file.h"
#include "recordings/axis_series.h"

namespace kerf::bench {

/// How well the parameters of a fit are known together: their covariance C, and the multiple q of a standard
/// error that their intervals reach to.
struct FitUncertainty {
  std::vector<std::string> parameters;
  std::vector<double> covariance;  ///< row by row
  double quantile = 0.0;           ///< q
  double confidence = 0.0;
};

/// What a fit.json says of the law of that file's name; nothing where it does not have it, or where the data
/// do not determine all that was searched. @throws nlohmann::json::exception where the file is none.
[[nodiscard]] std::optional<FitUncertainty> uncertainty_in(const nlohmann::ordered_json& fits,
                                                           const std::string& law_file);

/// Half the width of the interval of a law's force at each row, to first order in the parameters p:
///
///     w = q sqrt(g^T C g),   g = dF/dp
///
/// with C = sum of l_k l_k^T over its axes, so that g^T C g is the sum of the squared changes of F along
/// each l_k, by central differences. Of the curve, not of a further measurement: noise is not in it. Empty
/// where a parameter is none of the law's.
[[nodiscard]] std::vector<double> force_interval(const models::Law& law, const AxisSeries& series,
                                                 const FitUncertainty& known);

}  // namespace kerf::bench

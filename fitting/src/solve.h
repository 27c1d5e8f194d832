#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "samples.h"

namespace kerf::fitting {

/// What a solver is to search: a law's parameters, some of them held.
struct Problem {
  std::string_view model;
  models::Options law_options;
  std::vector<models::ParameterInfo> parameters;
  std::vector<bool> free;  ///< one a parameter

  [[nodiscard]] std::size_t free_count() const;
};

/// What a stretch of the samples contributes to a solution: its part of J^T J and of J^T r.
struct Stretch {
  Eigen::MatrixXd normal;
  Eigen::VectorXd score;
};

/// Into how many stretches of equal length the samples are divided.
inline constexpr Eigen::Index stretch_count = 20;

/// Where a search ended.
struct Solution {
  std::vector<double> values;  ///< of all parameters, in SI
  Eigen::MatrixXd normal;      ///< J^T J by the free parameters on their own scale (log or linear)
  std::vector<Stretch> stretches;
  double sum_of_squares = 0.0;
  bool converged = false;
  int iterations = 0;
  std::string message;
};

/// Least squares from a start, on the law's own step over the masked samples. Never throws for a start that
/// does not lead anywhere: it says so in the solution.
[[nodiscard]] Solution solve(const Problem& problem, const Samples& samples, const Mask& mask,
                             const std::vector<double>& start);

/// A value on the scale on which a parameter is searched, and back.
[[nodiscard]] double to_search_scale(const models::ParameterInfo& info, double value);
[[nodiscard]] double from_search_scale(const models::ParameterInfo& info, double value);

}  // namespace kerf::fitting

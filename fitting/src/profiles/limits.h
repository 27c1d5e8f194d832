#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "problem.h"
#include "uncertainty/uncertainty.h"

namespace kerf::fitting {

/// Between which values a parameter lies.
struct Limits {
  double lower = -std::numeric_limits<double>::infinity();  ///< infinite: the data set no limit
  double upper = std::numeric_limits<double>::infinity();
  IntervalBy by = IntervalBy::none;
  double p_zero = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no question, or not answered
};

/// Whether the smallest value that a law accepts stands for none: a spring of 1e-9 N/m is no spring.
[[nodiscard]] bool may_be_zero(const models::ParameterInfo& info);

inline constexpr double no_misfit_below = 3.0;  ///< samples of correlation time: nothing is left of a misfit

/// The second derivatives of half the sum of squares at its minimum, J^T J and what the residuals add to it
/// where the law misfits, by differences of the score; J^T J itself where they are not to be had, or are not
/// those of a minimum.
[[nodiscard]] Eigen::MatrixXd hessian_of(const Objective& objective, const Eigen::VectorXd& at,
                                         const Sums& sums);

/// Puts the second derivatives in place of J^T J: the covariance of an estimate by a law that misfits is
/// H^-1 (J^T Sigma J) H^-1. Source: [White1982].
void take_curvature(Uncertainty& uncertainty, const Sums& sums, const Eigen::MatrixXd& hessian);

/// Estimate and standard errors alone, which ask for no pass over the samples.
[[nodiscard]] std::vector<Limits> wald_limits_of(const Problem& problem, const Eigen::VectorXd& at,
                                                 const Uncertainty& uncertainty);

/// The interval of each coordinate, by the first rule that applies:
///
/// 1. Wald's, estimate +- quantile * standard error on the search scale, where half of it is no more than
///    0.1, a tenth of the parameter on a logarithmic scale and of its scale on a linear one.
/// 2. Wald's, where at both of its ends, the others following as if the sum of squares were a parabola, the
///    root of its rise is within 10 % of what a parabola has.
/// 3. The profile of the sum of squares, the others at their best along the ridge from the estimate or
///    elsewhere (elsewhere.h): where the root of its rise, in standard errors, reaches the
///    quantile; no limit on a side where it does not before the bound of the parameter, or only because
///    another one came to the end of its range. A lower bound that stands for none (may_be_zero()) is then
///    the limit, zero.
///
/// A curve of segments has Wald's at any width; the profile for all its parameters where a knot fails the
/// second rule, few samples being independent and nothing being left of a misfit.
///
/// With each, where the parameter may be zero, how likely estimates as far from it are if it is: by the
/// deviation of the best fit without it, one-sided where it cannot be negative [SelfLiang1987].
/// Coordinates are shared out among the threads; each is looked at alone.
/// Source: [BatesWatts1988], section 6.1 (profiles).
///
/// @param cheaper  makes the same objective at less cost, if there is one; it is asked for profiles, and what
///                 it says of their ends is held against the objective itself, which is asked where they
///                 differ
[[nodiscard]] std::vector<Limits> limits_of(
    const Problem& problem, const LawObjective& objective, const Eigen::VectorXd& at, const Sums& sums,
    const Eigen::MatrixXd& hessian, const Uncertainty& uncertainty, const std::vector<double>& scale,
    std::size_t threads = 1, const std::function<std::unique_ptr<const Objective>()>& cheaper = {});

/// Where the others are at their best while one is held away from its bound.
struct BestBeside {
  Eigen::VectorXd others;
  double left = 0.0;  ///< how far these may go from there, of how far they may while that one is at its bound
};

/// What is known of a coordinate that lies at its lower bound, which stands for none.
struct AboveZero {
  Limits limits;
  std::vector<BestBeside> beside;  ///< from near the bound to the limit; none where there is no limit
};

[[nodiscard]] AboveZero limits_above_zero(const Problem& problem, const LawObjective& objective,
                                          const Eigen::VectorXd& at, Eigen::Index held, const Sums& sums,
                                          const Uncertainty& uncertainty);

}  // namespace kerf::fitting

#pragma once

#include <array>

#include <Eigen/Core>

#include "psychometric/likelihood.h"

namespace kerf::psychophysics {

/// Where the curves of people come from: (threshold, ln slope) = mean + factor u, u ~ N(0, 1), on the scaled
/// axis of a Problem; `factor` is lower triangular.
struct Population {
  Eigen::Vector2d mean;
  Eigen::Matrix2d factor;
};

/// The mean (2), and of the factor the first column and the last corner (3).
using Parameters = std::array<double, 5>;

/// ln of the integral, over the curves that a subject may have, of the likelihood of its answers given the
/// curve: by adaptive quadrature of Gauss and Hermite, 7 x 7 points about the maximum. The gradient, by
/// Fisher's identity the mean of the gradient given the curve, is added to `gradient` if there is one.
/// @param lapse in [0, 1 - guess)
[[nodiscard]] double log_integral(const Problem& problem, double lapse, const Population& population,
                                  Parameters* gradient);

}  // namespace kerf::psychophysics

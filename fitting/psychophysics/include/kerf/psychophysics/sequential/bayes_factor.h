#pragma once

#include <span>

namespace kerf::psychophysics {

struct BayesFactorOptions {
  double scale = 0.70710678118654752;  ///< of the Cauchy prior of the effect, in standard deviations
  bool positive_alone = false;         ///< the effect, if there is one, is above 0: half a Cauchy
};

/// How much more likely the values, one a subject, are if there is an effect than if there is none
/// [Rouder2009]. The effect, in standard deviations between subjects, is Cauchy(0, r) beforehand, which is
/// N(0, g) with g = r^2 / x^2 and x ~ N(0, 1); with t and nu = n - 1 of Student's test
///
///     BF10 = mean over x of (1 + n g)^(-1/2) [(1 + t^2 / ((1 + n g) nu)) / (1 + t^2 / nu)]^(-n / 2)
///
/// and of an effect above 0 alone each part times twice the probability that it is above 0 given g. NaN where
/// all values are the same, which gives no t.
/// @throws std::invalid_argument: fewer than two values, one that is not finite, a scale not above 0.
[[nodiscard]] double bayes_factor(std::span<const double> values, const BayesFactorOptions& options = {});

/// The same of t itself, of `subjects` values.
[[nodiscard]] double bayes_factor_of_t(double t, int subjects, const BayesFactorOptions& options = {});

}  // namespace kerf::psychophysics

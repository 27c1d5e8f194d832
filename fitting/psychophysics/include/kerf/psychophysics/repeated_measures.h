#pragma once

#include <span>
#include <vector>

#include <kerf/psychophysics/binomial.h>

// The same people with every sample: the subject is the unit, whose own answers are averaged before.

namespace kerf::psychophysics {

/// The mean of values, one a subject, with Student's interval [Student1908]:
///
///     m +- t(n - 1; (1 + confidence) / 2) s / sqrt(n)
struct SubjectsMean {
  double mean = 0.0;
  double standard_error = 0.0;  ///< s / sqrt(n); 0: all values are the same
  double degrees_of_freedom = 1.0;
  Interval interval;

  /// Of the mean being `hypothesis`, two-sided. Without any spread 1 if it is, else 0.
  [[nodiscard]] double p_of(double hypothesis) const;
};
/// @throws std::invalid_argument: fewer than two values, one that is not finite, a confidence not in (0, 1).
[[nodiscard]] SubjectsMean subjects_mean(std::span<const double> values, double confidence = 0.95);

/// Whether samples differ, by their ranks within each subject [Friedman1937].
struct FriedmanTest {
  double statistic = 0.0;  ///< chi-squared, corrected for ties
  int degrees_of_freedom = 0;
  double p = 1.0;                  ///< of chi-squared
  std::vector<double> mean_ranks;  ///< of each sample, 1 the lowest
  double agreement = 0.0;          ///< Kendall's W = statistic / (n (k - 1)), from 0 to 1
};

/// rows[i][j]: what subject i said of sample j, the same k >= 2 samples for each of n >= 2 subjects. With the
/// sums R_j of ranks, of equal values the mean rank, and the sum T of t^3 - t over all ties of t values
///
///     Q = (12 sum_j (R_j - n (k + 1) / 2)^2) / (n k (k + 1) - T / (k - 1))
///
/// is chi-squared of k - 1 degrees of freedom, nearly, from about six subjects on. Where nobody tells any two
/// samples apart Q is 0 and p 1.
/// @throws std::invalid_argument: fewer, rows of unlike length, a value that is not finite.
[[nodiscard]] FriedmanTest friedman_test(const std::vector<std::vector<double>>& rows);

/// The slope b of the line y = a + b x by least squares.
/// @throws std::invalid_argument: fewer than two points, as many x as y not, all x the same.
[[nodiscard]] double slope_of_line(std::span<const double> x, std::span<const double> y);

}  // namespace kerf::psychophysics

#pragma once

#include <optional>
#include <span>
#include <vector>

#include <kerf/psychophysics/psychometric_fit.h>

// One psychometric function for the people that subjects stand for: each subject has a curve of its own, and
// the curves come from one distribution.

namespace kerf::psychophysics {

struct MixedOptions {
  Shape shape = Shape::weibull;
  Axis axis = Axis::logarithmic;
  double guess = 0.5;  ///< known, as in FitOptions
  /// Lapses at both ends, psi = lapse + (1 - 2 lapse) F, of a curve that goes from "less" to "more"; `guess`
  /// is not used.
  bool two_sided = false;
  std::optional<double>
      lapse;  ///< of all subjects: fixed at this; otherwise the likeliest of 0, 2, 4 and 6 %
  std::optional<double>
      criterion;              ///< psi at the threshold; standard: guess + (1 - guess) / 2; two-sided 0.5
  bool slopes_differ = true;  ///< false: one slope for all, as of a model with random intercepts alone
};

/// A quantity of people: its mean over them and how far they lie apart.
struct OfPeople {
  double mean = 0.0;  ///< geometric where `is_ratio`
  bool is_ratio = false;
  double deviation =
      0.0;  ///< between people, free of the errors of their few answers; of ln where `is_ratio`
  double degrees_of_freedom = 0.0;
  /// What it is with another lapse rate than the likeliest, and how much less likely that is.
  struct WithLapse {
    double mean = 0.0;
    double standard_error = 0.0;  ///< of the mean; of its logarithm where `is_ratio`
    double loss = 0.0;            ///< twice that of log-likelihood
  };
  std::vector<WithLapse> with_lapses;  ///< the likeliest, of no loss, among them

  /// Of the mean, t Student's quantile: all values that one of the lapse rates holds within
  ///
  ///     mean +- standard_error sqrt(t^2 - loss)
  [[nodiscard]] Interval interval(double confidence = 0.95) const;
};

struct MixedFit {
  /// Where the curve reaches the criterion, on its axis: of a logarithmic one the geometric mean, and the
  /// deviation is that of the logarithm.
  OfPeople threshold;        ///< a ratio on a logarithmic axis
  OfPeople slope;            ///< a ratio; > 0
  double correlation = 0.0;  ///< of threshold and ln(slope) between people; 0 where either does not vary
  double lapse = 0.0;
  double log_likelihood = 0.0;  ///< without binomial coefficients
  std::size_t subjects = 0;
};

/// Subject s answers by psi(x) with the threshold a_s on the axis and the slope exp(b_s),
///
///     z = q + exp(b_s) (x - a_s),   (a_s, b_s) ~ N((a, b), S),   F(q) = (criterion - guess) / (1 - guess -
///     lapse)
///
/// and a, b and S have the largest likelihood
///
///     L = prod over s of  integral psi(...)^k (1 - psi(...))^(n - k) N((a_s, b_s)) d(a_s, b_s)
///
/// integrated by Gauss and Hermite about each subject's own maximum (adaptive quadrature [PinheiroBates1995],
/// 7 x 7 points; a generalised linear mixed model [Moscatelli2012] where slopes are alike). Subjects whose
/// own curve has no threshold count as what they are: answers. The errors are those of the information about
/// (a, b), grown by sqrt(n / (n - 1)), for S is estimated, too; of subjects - 1 degrees of freedom.
/// @throws std::invalid_argument: less than three subjects; one without answers, or all of whose answers
/// together
///         are at one level; all answers right, or none; options out of their range; no largest likelihood
///         found.
[[nodiscard]] MixedFit fit_mixed(std::span<const std::vector<Level>> subjects, const MixedOptions& options);

/// Half the way between the points where F is 25 and 75 %, as half_interquartile() of one subject: a fraction
/// of the standard, for people. Of a linear axis.
[[nodiscard]] OfPeople half_interquartile(const MixedFit& fit, Shape shape);

}  // namespace kerf::psychophysics

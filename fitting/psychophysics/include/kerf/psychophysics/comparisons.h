#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <kerf/psychophysics/sign_flips.h>

namespace kerf::psychophysics {

/// wins[i][j]: how often i was preferred to j. The diagonal is not used.
using Wins = std::vector<std::vector<int>>;

enum class Scale {
  bradley_terry,  ///< P(i over j) = 1 / (1 + exp(-(w_i - w_j))): worth in log odds [BradleyTerry1952]
  thurstone,      ///< P(i over j) = Phi((w_i - w_j) / sqrt2): case V, worth in d' [Thurstone1927]
};

struct Ranking {
  Scale scale = Scale::bradley_terry;
  std::vector<double> worth;  ///< they add up to zero
  std::vector<double> standard_error;
  std::vector<std::vector<double>> covariance;
  double log_likelihood = 0.0;
  double ratio = 0.0;  ///< likelihood ratio against "all are equal": chi-squared of items - 1
  int ratio_degrees_of_freedom = 0;
  double ratio_p = 1.0;
  double deviance = 0.0;  ///< against a free probability for each pair: does one scale describe them?
  int deviance_degrees_of_freedom = 0;
  double deviance_p = 1.0;  ///< 1 where no degree of freedom is left
};

/// Worth of two to fifty items by maximum likelihood (scoring; the likelihood is concave). Refused where
/// there is no finite answer: if the items fall into two groups of which one never won against the other
/// [Ford1957].
[[nodiscard]] Ranking rank(const Wins& wins, Scale scale = Scale::bradley_terry);

struct Difference {
  double value = 0.0;
  double standard_error = 0.0;
  double p = 1.0;  ///< two-sided, normal (Wald), or Student's; correct it where several pairs are looked at
};

[[nodiscard]] Difference difference(const Ranking& ranking, std::size_t first, std::size_t second);

/// A ranking of answers of several subjects, each of whom may have a taste of their own. Their answers are
/// not independent: one of 12 with a taste counts 12 times in `Ranking`, whose errors and ratio_p know
/// nothing of it.
struct SubjectsRanking {
  Ranking pooled;  ///< whose worths these are
  std::size_t subjects = 0;
  /// Of the worths over subjects drawn anew, by leaving out each subject s once,
  ///
  ///     C = (n - 1) / n  sum of d_s d_s',   d_s = (I - I_s)^-1 g_s
  ///
  /// with the information I of all, and I_s and the gradient g_s of one at the pooled worths: a step of
  /// Newton's towards what the others say (the estimate CR3 of [BellMcCaffrey2002]).
  std::vector<std::vector<double>> covariance;
  /// Are all equal on the average of the people that the subjects stand for? The score
  ///
  ///     T = g' I^+ g,   at equal worths,
  ///
  /// against what it is when the answers of each subject are all turned round or not: a subject whose tastes
  /// are symmetric about none could as well have had the opposite ones (as flip_signs()). Exact up to 14
  /// subjects, of more some flips are drawn.
  double p = 1.0;
  double least_p = 1.0;  ///< the least that p can be: 2 / 2^subjects
  bool is_exact = true;
};

/// @throws std::invalid_argument: less than two subjects; one without answers; as rank() of all answers
///         together; pairs that nobody compared but one subject, without whom the items fall apart.
[[nodiscard]] SubjectsRanking rank_over_subjects(std::span<const Wins> subjects,
                                                 const SignFlipOptions& options = {},
                                                 Scale scale = Scale::bradley_terry);

/// With the errors over subjects; p by Student's t of subjects - 1 degrees of freedom.
[[nodiscard]] Difference difference(const SubjectsRanking& ranking, std::size_t first, std::size_t second);

/// Adjusted p values, in the order given, which may be compared with the level: Holm [Holm1979] keeps the
/// chance of any false alarm under it,
///
///     p'_(i) = max_{j <= i} min(1, (m - j + 1) p_(j))
[[nodiscard]] std::vector<double> holm(std::span<const double> p);

/// Benjamini and Hochberg [BenjaminiHochberg1995] keep the expected share of false alarms among all alarms
/// under the level, for tests that are independent or positively dependent,
///
///     p'_(i) = min_{j >= i} min(1, m / j p_(j))
[[nodiscard]] std::vector<double> benjamini_hochberg(std::span<const double> p);

}  // namespace kerf::psychophysics

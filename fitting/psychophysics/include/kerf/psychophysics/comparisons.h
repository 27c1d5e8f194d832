#pragma once

#include <cstddef>
#include <span>
#include <vector>

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
  double p = 1.0;  ///< two-sided, normal (Wald); correct it where several pairs are looked at
};

[[nodiscard]] Difference difference(const Ranking& ranking, std::size_t first, std::size_t second);

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

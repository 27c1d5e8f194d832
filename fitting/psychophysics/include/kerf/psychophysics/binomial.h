#pragma once

namespace kerf::psychophysics {

/// So many successes in so many independent trials.
struct Count {
  int successes = 0;  ///< >= 0
  int trials = 0;     ///< >= successes
};

struct Interval {
  double lower = 0.0;
  double upper = 0.0;
};

enum class Alternative { two_sided, greater, less };

/// Exact binomial test: how likely a result at least as extreme is if every trial succeeds with probability
/// `chance`, 0 < chance < 1.
///
///     greater: P(X >= k)    less: P(X <= k)    two-sided: sum of P(X = i) over all i with P(X = i) <= P(X =
///     k)
///
/// The two-sided test is that of small p-values, with probabilities within 1e-7 of each other taken as equal,
/// as R's binom.test does it. It is conservative: false alarms are at most what they are said to be.
[[nodiscard]] double binomial_test(Count count, double chance,
                                   Alternative alternative = Alternative::two_sided);

/// Interval of Clopper and Pearson [ClopperPearson1934]: every probability that neither one-sided test at (1
/// - confidence) / 2 refuses. Covers the truth at least as often as it says, for any number of trials.
///
///     lower = B(a / 2; k, n - k + 1),  upper = B(1 - a / 2; k + 1, n - k),  B the beta quantile, a = 1 -
///     confidence
[[nodiscard]] Interval clopper_pearson(Count count, double confidence = 0.95);

/// Score interval of Wilson [Wilson1927]: shorter, and covers as often as it says on the average over
/// probabilities.
///
///     (p + z^2 / 2n +- z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n)
[[nodiscard]] Interval wilson(Count count, double confidence = 0.95);

/// What a binomial test is to find: `truth` where `chance` is the null.
struct BinomialDesign {
  double chance = 0.5;  ///< 0 < chance < 1
  double truth = 0.75;  ///< 0 <= truth <= 1
  Alternative alternative = Alternative::two_sided;
  double level = 0.05;  ///< of the test
};

/// Probability that the exact test refuses `chance`. With `truth` = `chance`: the actual rate of false
/// alarms.
[[nodiscard]] double binomial_power(const BinomialDesign& design, int trials);

/// Least number of trials from which on the power never falls below `power` again: it goes up in a saw-tooth,
/// and a lucky number is no design. Refuses what would take more than 100,000 trials.
[[nodiscard]] int trials_for_power(const BinomialDesign& design, double power = 0.8);

}  // namespace kerf::psychophysics

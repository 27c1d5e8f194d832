#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::psychophysics {

/// How much of alpha may have been spent when a fraction t of all information is in [LanDeMets1983], of each
/// side that a test has:
///
///     obrien_fleming   2 - 2 Phi(z(alpha / 2) / sqrt(t))    hardly anything early
///     pocock           alpha ln(1 + (e - 1) t)              much the same at each look
enum class SpendingFunction : std::uint8_t { obrien_fleming, pocock };

struct AlphaSpending {
  SpendingFunction function = SpendingFunction::obrien_fleming;
  double alpha = 0.05;  ///< of the whole study, of both sides together where there are two
  bool two_sided = false;
};

/// Spent by the fraction t of the information, of both sides; all of it from t = 1 on.
/// @throws std::invalid_argument: alpha not in (0, 0.5), t not above 0.
[[nodiscard]] double alpha_spent(const AlphaSpending& spending, double fraction);

/// One look at a study under way.
struct SpendingBound {
  double fraction = 0.0;  ///< of the information
  double spent = 0.0;     ///< of alpha, this look included
  double z = 0.0;         ///< the statistic has to reach it; infinite where nothing is left to spend
  double nominal = 0.0;   ///< the p value that is reached there, of both sides if there are two
};

/// Where the statistic of each look, Z(k) with correlations sqrt(I(j) / I(k)), crosses for the first time
/// with just the probability that its look may spend:
///
///     P(Z(1) < z(1), ..., Z(k-1) < z(k-1), Z(k) >= z(k)) = spent(t(k)) - spent(t(k-1))
///
/// by numerical integration over the region where the study goes on [Armitage1969]. Looks need not be where
/// they were planned: a bound depends on those before it alone. `information` ascends; `full` is what was
/// planned, and beyond it a look spends what is left.
/// @throws std::invalid_argument: no look, more than 200, information that does not ascend.
[[nodiscard]] std::vector<SpendingBound> spending_bounds(const AlphaSpending& spending,
                                                         std::span<const double> information, double full);

}  // namespace kerf::psychophysics

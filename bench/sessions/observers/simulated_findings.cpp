#include "observers/simulated_findings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/core.h>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

bool holds(const psychophysics::Interval& interval, double value) {
  return interval.lower <= value && value <= interval.upper;
}

/// NaN of nothing.
double middle_of(std::vector<double> values) {
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : median(std::move(values));
}

/// Mean and standard deviation of ln(estimate / truth), and how wide the intervals are.
void add_jnds(const std::vector<MainResult>& results, double truth, SimulatedFindings& found) {
  std::vector<double> errors;
  std::vector<double> ratios;
  double sum = 0.0;
  for (const MainResult& result : results) {
    count(found.jnd_found, std::isfinite(result.jnd));
    if (!std::isfinite(result.jnd)) continue;
    const psychophysics::Interval& interval = result.jnd_interval;
    count(found.jnd_bounded, interval.lower > 0.0 && std::isfinite(interval.upper));
    ratios.push_back(interval.lower > 0.0 ? interval.upper / interval.lower
                                          : std::numeric_limits<double>::infinity());
    if (!std::isfinite(truth)) continue;
    count(found.jnd_covered, holds(interval, truth));
    if (result.jnd <= 0.0) continue;
    errors.push_back(std::log(result.jnd / truth));
    sum += errors.back();
  }
  found.jnd_ratio = middle_of(ratios);
  if (errors.size() < 2) return;
  const auto n = static_cast<double>(errors.size());
  const double mean = sum / n;
  double squares = 0.0;
  for (const double error : errors) squares += (error - mean) * (error - mean);
  found.jnd_bias = std::expm1(mean);
  found.jnd_spread = std::sqrt(squares / (n - 1.0));
}

/// The start of a note is its kind; what follows tells of one experiment.
std::vector<std::string> counted_notes(const std::vector<MainResult>& results) {
  std::map<std::string, std::size_t> kinds;
  for (const MainResult& result : results) {
    if (!std::isfinite(result.jnd) && !result.note.empty())
      ++kinds[result.note.substr(0, result.note.find_first_of("0123456789;"))];
  }
  std::vector<std::pair<std::size_t, std::string>> ordered;
  for (const auto& [kind, times] : kinds) ordered.emplace_back(times, kind);
  std::ranges::sort(ordered, std::greater());
  std::vector<std::string> notes;
  for (const auto& [times, kind] : ordered) notes.push_back(fmt::format("{} x {}...", times, kind));
  return notes;
}

}  // namespace

void count(SimulatedShare& share, bool is_so) {
  ++share.count.trials;
  share.count.successes += is_so ? 1 : 0;
}

double SimulatedShare::value() const noexcept {
  if (count.trials == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(count.successes) / count.trials;
}

psychophysics::Interval SimulatedShare::interval() const {
  if (count.trials == 0) return {.lower = 0.0, .upper = 1.0};
  return psychophysics::clopper_pearson(count);
}

SimulatedFindings findings_of(const std::vector<MainResult>& results, const SimulatedTruth& truth,
                              double level) {
  SimulatedFindings found;
  std::vector<double> d_primes;
  std::vector<double> exponents;
  for (const MainResult& result : results) {
    found.trials += static_cast<double>(result.trials) / static_cast<double>(results.size());
    if (std::isfinite(result.p_value)) count(found.significant, result.p_value < level);
    if (result.equivalent) count(found.equivalent, *result.equivalent);
    if (std::isfinite(result.exponent) && std::isfinite(truth.exponent)) {
      exponents.push_back(result.exponent);
      count(found.exponent_covered, holds(result.exponent_interval, truth.exponent));
    }
    if (!std::isnan(result.d_prime) && std::isfinite(truth.d_prime)) {
      d_primes.push_back(result.d_prime);
      count(found.d_prime_covered, holds(result.d_prime_interval, truth.d_prime));
    }
  }
  if (!exponents.empty())
    found.exponent_mean =
        std::accumulate(exponents.begin(), exponents.end(), 0.0) / static_cast<double>(exponents.size());
  found.d_prime_median = middle_of(std::move(d_primes));
  if (truth.is_of_levels) add_jnds(results, truth.jnd, found);
  found.notes = counted_notes(results);
  return found;
}

}  // namespace kerf::bench

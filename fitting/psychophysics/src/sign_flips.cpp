#include <algorithm>
#include <cmath>
#include <vector>

#include <kerf/psychophysics/random.h>
#include <kerf/psychophysics/sign_flips.h>

#include "checks.h"

namespace kerf::psychophysics {
namespace {

constexpr std::size_t most_values_counted = 36;

/// The sums of all flips of some values, ascending.
std::vector<double> flipped_sums(std::span<const double> values) {
  std::vector<double> sums{0.0};
  for (const double value : values) {
    // Both halves are ascending, and so is what they merge into.
    std::vector<double> less = sums;
    std::vector<double> more = sums;
    for (double& sum : less) sum -= std::abs(value);
    for (double& sum : more) sum += std::abs(value);
    sums.resize(2 * less.size());
    std::merge(less.begin(), less.end(), more.begin(), more.end(), sums.begin());
  }
  return sums;
}

/// The share of all flips whose sum is at least `least`: those of one half of the values against those of the
/// other.
double counted_share(std::span<const double> values, double least) {
  const std::vector<double> first = flipped_sums(values.first(values.size() / 2));
  const std::vector<double> second = flipped_sums(values.subspan(values.size() / 2));
  double count = 0.0;
  std::size_t reaching = 0;  // of the second half, from its largest on
  for (const double sum : first) {
    while (reaching < second.size() && sum + second[second.size() - 1 - reaching] >= least) ++reaching;
    count += static_cast<double>(reaching);
  }
  return count / static_cast<double>(first.size()) / static_cast<double>(second.size());
}

double drawn_share(std::span<const double> values, double least, const SignFlipOptions& options) {
  Random random(options.seed);
  int as_large = 1;
  for (int sample = 0; sample < options.samples; ++sample) {
    double sum = 0.0;
    for (const double value : values) sum += random.below(2) == 0 ? value : -value;
    as_large += sum >= least ? 1 : 0;
  }
  return static_cast<double>(as_large) / (1.0 + options.samples);
}

}  // namespace

SignFlips flip_signs(std::span<const double> values, const SignFlipOptions& options) {
  require(!values.empty(), "there are no values whose signs could be flipped");
  require(options.samples >= 99, "flips that are drawn must be 99 or more");
  double sum = 0.0;
  double size = 0.0;
  std::size_t others = 0;
  for (const double value : values) {
    require(std::isfinite(value), "a value whose sign is to be flipped is not finite");
    sum += value;
    size += std::abs(value);
    others += value == 0.0 ? 0 : 1;
  }
  const bool is_exact = values.size() <= most_values_counted;
  const double rounding = 1e-12 * size;
  const auto share = [&](double least) {
    return is_exact ? counted_share(values, least - rounding)
                    : drawn_share(values, least - rounding, options);
  };
  SignFlips result{.mean = sum / static_cast<double>(values.size()), .is_exact = is_exact};
  result.p_greater = share(sum);
  result.p_two_sided = std::abs(sum) <= rounding ? 1.0 : std::min(1.0, 2.0 * share(std::abs(sum)));
  result.least_p = is_exact ? std::exp2(-static_cast<double>(others)) : 1.0 / (1.0 + options.samples);
  return result;
}

}  // namespace kerf::psychophysics

#include "inspect/signal_facts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_set>

#include "signal/held_values.h"
#include "signal/quantiles.h"
#include "signal/row_noise.h"
#include "signal/streamed_median.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_levels = std::size_t{1} << 18U;
constexpr double worth_a_word = 0.01;
constexpr double beyond_a_step = 2.5;

/// The median of sizes that were rounded to steps: within the step that it lies in by the share of the rows.
template <typename ForEach>
double median_within_step(const ForEach& for_each, double middle, double quantum) {
  const double begin = std::max(0.0, middle - 0.5 * quantum);
  const double end = middle + 0.5 * quantum;
  double before = 0.0;
  double within = 0.0;
  double all = 0.0;
  for_each([&](double size) {
    all += 1.0;
    before += size < begin ? 1.0 : 0.0;
    within += size >= begin && size < end ? 1.0 : 0.0;
  });
  return within > 0.0 ? begin + (end - begin) * (0.5 * all - before) / within : middle;
}

void add_zero_facts(SignalFacts& facts, const BlockedValues& values) {
  std::uint64_t run = 0;
  for (std::uint64_t row = 0; row < values.size(); ++row) {
    const double value = values[row];
    run = value == 0.0 ? run + 1 : 0;
    facts.zeros += run > 0 ? 1 : 0;
    facts.longest_zeros = std::max(facts.longest_zeros, run);
    if (!std::isfinite(value)) {
      ++facts.not_finite;
      continue;
    }
    facts.least = std::isnan(facts.least) ? value : std::min(facts.least, value);
    facts.most = std::isnan(facts.most) ? value : std::max(facts.most, value);
    facts.below_zero = facts.below_zero || value < 0.0;
    facts.above_zero = facts.above_zero || value > 0.0;
    if (value != 0.0)
      facts.nearest_zero = std::min(std::abs(value), facts.nearest_zero.value_or(std::abs(value)));
  }
}

}  // namespace

bool SignalFacts::is_blind_at_zero() const {
  if (static_cast<double>(zeros) < worth_a_word * static_cast<double>(rows) || !nearest_zero) return false;
  return below_zero != above_zero || !quantum || *nearest_zero > beyond_a_step * *quantum;
}

std::optional<double> quantum_of(const BlockedValues& values) {
  std::unordered_set<std::uint64_t> seen;
  std::uint64_t changes = 0;
  for (std::uint64_t row = 0; row < values.size(); ++row) {
    const double value = values[row] + 0.0;  // one zero, not two
    if (!std::isfinite(value)) continue;
    if (row > 0 && values[row - 1] != value) ++changes;
    seen.insert(std::bit_cast<std::uint64_t>(value));
    if (seen.size() > most_levels) return std::nullopt;
  }
  if (seen.size() < 3 || 3 * seen.size() > changes) return std::nullopt;
  std::vector<double> levels;
  for (const std::uint64_t bits : seen) levels.push_back(std::bit_cast<double>(bits));
  std::ranges::sort(levels);
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) levels[i] = levels[i + 1] - levels[i];
  levels.pop_back();
  return median(std::move(levels));
}

std::optional<double> noise_of(const BlockedValues& values, std::optional<double> quantum,
                               const NoiseRows& which) {
  const auto each = [&](const auto& look) {
    InSpans in_spans(which.spans);
    const auto look_at = [&](double size) {
      if (size > 0.0 || quantum) look(size);
    };
    each_second_difference(
        values, [&](std::size_t row) { return in_spans(row) == which.inside; }, look_at);
  };
  double middle = StreamedMedian::of(each);
  if (std::isnan(middle)) return std::nullopt;
  if (quantum) middle = median_within_step(each, middle, *quantum);
  return std::max(noise_of_second_differences(middle), quantum.value_or(0.0) / std::sqrt(12.0));
}

SignalFacts signal_facts(const BlockedValues& values) {
  SignalFacts facts{.rows = values.size(), .quantum = quantum_of(values), .largest_outliers = {}};
  facts.noise = noise_of(values, facts.quantum);
  add_zero_facts(facts, values);
  facts.held_rows = rows_held(values);
  return facts;
}

void find_outliers(SignalFacts& facts, const BlockedValues& values, double noise) {
  const auto higher = [](const SingleRow& a, const SingleRow& b) { return a.height > b.height; };
  auto& largest = facts.largest_outliers;
  if (!(noise > 0.0)) return;
  facts.outliers = 0;
  const auto every = [](std::size_t) { return true; };
  each_single_row(values, every, noise, [&](std::size_t row, double height) {
    ++*facts.outliers;
    largest.push_back({.row = row, .value = values[row], .height = height});
    std::ranges::push_heap(largest, higher);
    if (largest.size() <= SignalFacts::most_outliers) return;
    std::ranges::pop_heap(largest, higher);
    largest.pop_back();
  });
  std::ranges::sort(largest, higher);
}

}  // namespace kerf::bench

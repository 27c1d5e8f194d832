#include "signal/smoothed_values.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

/// Of a grid that is filtered in minutes: 11 days at 1 kHz.
constexpr double most_periods = 1e9;

/// The value between two others, of which `after` is the second; at the ends theirs.
template <typename Times, typename Values>
double between(const Times& time_s, const Values& values, std::uint64_t after, double at_s) {
  if (after == 0) return values[0];
  if (after == values.size()) return values[after - 1];
  const double before_s = time_s[after - 1];
  const double before = values[after - 1];
  const double share = (at_s - before_s) / (time_s[after] - before_s);
  return before + share * (values[after] - before);
}

/// How many steps of a period begin within a span, its ends included.
std::uint64_t steps_within(double span_s, double period_s) {
  auto steps = static_cast<std::uint64_t>(span_s / period_s);
  while (static_cast<double>(steps) * period_s <= span_s) ++steps;
  while (static_cast<double>(steps - 1) * period_s > span_s) --steps;
  return steps;
}

}  // namespace

UniformTimes::UniformTimes(const BlockedValues& time_s, double period_s)
    : time_s_(time_s), first_s_(time_s[0]), period_s_(period_s), size_(0) {
  if (!(period_s > 0.0))
    throw std::invalid_argument("a filter needs two samples or more, at times that increase");
  const double span_s = time_s[time_s.size() - 1] - first_s_;
  if (!(span_s <= most_periods * period_s)) {
    throw std::invalid_argument(fmt::format(
        "the times span {:.3g} s, too long for a filter at a period of {:.3g} s", span_s, period_s));
  }
  for (std::uint64_t sample = 0; sample < time_s.size(); ++sample) {
    const double at_s = time_s[sample];
    if (sample > 0 && !(at_s >= time_s[sample - 1])) {
      throw std::invalid_argument(fmt::format(
          "row {} is earlier than the one before it; a filter needs times that increase", sample));
    }
    while (at_s > (*this)[sample_after_.size() * BlockedValues::block]) sample_after_.push_back(sample);
  }
  size_ = steps_within(span_s, period_s);
  sample_after_.resize(static_cast<std::size_t>(size_ / BlockedValues::block + 1), time_s.size());
}

std::uint64_t UniformTimes::after(double time_s) const noexcept {
  auto at = std::min(size_, static_cast<std::uint64_t>((time_s - first_s_) / period_s_));
  while (at < size_ && (*this)[at] <= time_s) ++at;
  while (at > 0 && (*this)[at - 1] > time_s) --at;
  return at;
}

SmoothedValues::SmoothedValues(const BlockedValues& samples, const UniformTimes& grid, double corner_hz)
    : filter_({.kind = FilterKind::butterworth2, .corner_hz = corner_hz}, grid.rate_hz()),
      uniform_(grid.size(),
               [&samples, &grid](std::uint64_t first, std::span<double> values) {
                 const BlockedValues& time_s = grid.of_samples();
                 std::uint64_t after = grid.sample_after(first / BlockedValues::block);
                 for (double& value : values) {
                   const double at_s = grid[first++];
                   while (after < time_s.size() && time_s[after] <= at_s) ++after;
                   value = between(time_s, samples, after, at_s);
                 }
               }),
      filtered_(filter_, uniform_),
      smooth_(grid.size(),
              [this](std::uint64_t first, std::span<double> values) { filtered_.read(first, values); }),
      at_samples_(samples.size(), [this, &grid](std::uint64_t first, std::span<double> values) {
        for (double& value : values) {
          const double at_s = grid.of_samples()[first++];
          value = between(grid, smooth_, grid.after(at_s), at_s);
        }
      }) {}

}  // namespace kerf::bench

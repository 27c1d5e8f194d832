#include "signal/blocked_filter.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace kerf::bench {
namespace {

constexpr std::uint64_t block = BlockedValues::block;
constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

}  // namespace

BlockedFilter::BlockedFilter(const SampledFilter& filter, const BlockedValues& samples)
    : samples_(samples), reach_(filter.mirrored(samples.size())), computed_(none) {
  const std::uint64_t blocks = (size() + block - 1) / block;
  SampledFilter::Recursion run = filter.settled_at(extended(0));
  double last = 0.0;
  for (std::uint64_t number = 0; number < blocks; ++number) {
    forward_.push_back(run);
    run = run_forward(number);
    last = values_.back();
  }
  run = filter.settled_at(last);
  backward_.assign(forward_.size(), run);
  for (std::uint64_t number = blocks; number-- > 0;) {
    backward_[number] = run;
    if (number + 1 < blocks) (void)run_forward(number);  // the last one still is
    run = run_backward(number);
  }
}

void BlockedFilter::read(std::uint64_t first, std::span<double> values) {
  std::uint64_t at = first + reach_;
  for (double& value : values) {
    compute(at / block);
    value = values_[static_cast<std::size_t>(at++ % block)];
  }
}

std::uint64_t BlockedFilter::size() const { return samples_.size() + 2 * reach_; }

/// The samples, with those mirrored through the first before them and through the last behind them.
double BlockedFilter::extended(std::uint64_t at) const {
  if (at < reach_) return 2.0 * samples_[0] - samples_[reach_ - at];
  const std::uint64_t last = samples_.size() - 1;
  if (at - reach_ <= last) return samples_[at - reach_];
  return 2.0 * samples_[last] - samples_[2 * last + reach_ - at];
}

void BlockedFilter::compute(std::uint64_t number) {
  if (number == computed_) return;
  computed_ = none;
  (void)run_forward(number);
  (void)run_backward(number);
  computed_ = number;
}

SampledFilter::Recursion BlockedFilter::run_forward(std::uint64_t number) {
  const std::uint64_t first = number * block;
  values_.resize(static_cast<std::size_t>(std::min(block, size() - first)));
  SampledFilter::Recursion run = forward_[number];
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = run.step(extended(first + i));
  return run;
}

SampledFilter::Recursion BlockedFilter::run_backward(std::uint64_t number) {
  SampledFilter::Recursion run = backward_[number];
  for (auto value = values_.rbegin(); value != values_.rend(); ++value) *value = run.step(*value);
  return run;
}

}  // namespace kerf::bench

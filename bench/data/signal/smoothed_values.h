#pragma once

#include <cstdint>
#include <vector>

#include "signal/blocked_filter.h"
#include "signal/blocked_values.h"
#include "signal/filters.h"

namespace kerf::bench {

/// The uniform grid of samples at any times, from the first to the last of them: as UniformSamples has it
/// where there is no gap, without all times at once.
class UniformTimes {
 public:
  /// `time_s` stays where it is; goes through it once.
  /// @throws std::invalid_argument unless the period is positive and the times never decrease.
  UniformTimes(const BlockedValues& time_s, double period_s);

  [[nodiscard]] const BlockedValues& of_samples() const noexcept { return time_s_; }
  [[nodiscard]] double rate_hz() const noexcept { return 1.0 / period_s_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// Requires at < size().
  [[nodiscard]] double operator[](std::uint64_t at) const noexcept {
    return first_s_ + static_cast<double>(at) * period_s_;
  }
  /// The first sample after the time with which a block of the grid begins.
  [[nodiscard]] std::uint64_t sample_after(std::uint64_t block) const { return sample_after_[block]; }
  /// The first time of the grid after that of a sample.
  [[nodiscard]] std::uint64_t after(double time_s) const noexcept;

 private:
  const BlockedValues& time_s_;
  double first_s_;
  double period_s_;
  std::uint64_t size_;
  std::vector<std::uint64_t> sample_after_;  ///< of each block
};

/// Samples at any times, low-passed (a second-order Butterworth filter, zero phase): interpolated linearly on
/// the grid, filtered, and interpolated back. What low_pass_zero_phase() makes of UniformSamples, to the last
/// bit, some of it at a time.
class SmoothedValues {
 public:
  /// Samples and grid stay where they are; goes through the samples twice.
  SmoothedValues(const BlockedValues& samples, const UniformTimes& grid, double corner_hz);
  SmoothedValues(const SmoothedValues&) = delete;
  SmoothedValues& operator=(const SmoothedValues&) = delete;
  ~SmoothedValues() = default;

  [[nodiscard]] std::uint64_t size() const noexcept { return at_samples_.size(); }
  [[nodiscard]] double operator[](std::uint64_t at) const { return at_samples_[at]; }

 private:
  SampledFilter filter_;
  BlockedValues uniform_;
  BlockedFilter filtered_;
  BlockedValues smooth_;  ///< on the grid
  BlockedValues at_samples_;
};

}  // namespace kerf::bench

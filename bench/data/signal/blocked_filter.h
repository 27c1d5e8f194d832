#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "signal/blocked_values.h"
#include "signal/filters.h"

namespace kerf::bench {

/// What a recursive zero-phase filter gives, to the last bit, without all samples at once.
///
/// It is run forward and backward once, keeping its state at the begin of every block and, on the way back,
/// at the end: from these two any block is computed from its own samples alone.
class BlockedFilter {
 public:
  /// `samples` stays where it is. @throws std::invalid_argument for fewer than two samples, or a filter of
  /// another kind.
  BlockedFilter(const SampledFilter& filter, const BlockedValues& samples);

  /// The filtered samples from `first` on; those of a few blocks are computed for it.
  void read(std::uint64_t first, std::span<double> values);

 private:
  [[nodiscard]] std::uint64_t size() const;  ///< with what is mirrored
  [[nodiscard]] double extended(std::uint64_t at) const;
  void compute(std::uint64_t block);
  // Each gives the state in which it leaves the block.
  [[nodiscard]] SampledFilter::Recursion run_forward(std::uint64_t block);
  [[nodiscard]] SampledFilter::Recursion run_backward(std::uint64_t block);

  const BlockedValues& samples_;
  std::uint64_t reach_;                             ///< samples that are mirrored at each end
  std::vector<SampledFilter::Recursion> forward_;   ///< as it comes into each block
  std::vector<SampledFilter::Recursion> backward_;  ///< as it comes back into each
  std::vector<double> values_;                      ///< of the block computed last
  std::uint64_t computed_;                          ///< its number
};

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <limits>
#include <map>

#include "signal/ordered_bits.h"

namespace kerf::bench {

/// How often each of some values came, where few differ: their median is known without any pass over them.
/// Takes memory for each value that differs from the others.
class ValueCounts {
 public:
  void add(double value) {
    ++counts_[ordered_bits(value)];
    ++total_;
  }

  /// Exactly what median() gives of all of them; NaN without values.
  [[nodiscard]] double median() const {
    if (total_ == 0) return std::numeric_limits<double>::quiet_NaN();
    return 0.5 * (of_rank((total_ - 1) / 2) + of_rank(total_ / 2));
  }

  /// How many are greater.
  [[nodiscard]] std::uint64_t above(double limit) const {
    std::uint64_t greater = 0;
    for (const auto& [bits, count] : counts_) greater += value_of_ordered(bits) > limit ? count : 0;
    return greater;
  }

 private:
  [[nodiscard]] double of_rank(std::uint64_t rank) const {
    auto entry = counts_.begin();
    while (rank >= entry->second) rank -= (entry++)->second;
    return value_of_ordered(entry->first);
  }

  std::map<std::uint64_t, std::uint64_t> counts_;  ///< by ordered_bits()
  std::uint64_t total_ = 0;
};

}  // namespace kerf::bench

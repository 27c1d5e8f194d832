#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "signal/ordered_bits.h"

namespace kerf::bench {

/// The median of values that are gone through five times instead of being kept: exactly what median() gives,
/// in 2 MB however many there are. A few are kept after all, in one pass.
///
/// Numbers ordered as their bits are: each pass counts by further bits those that begin as the median does,
/// as far as that is known.
class StreamedMedian {
 public:
  /// @param for_each calls what it is given with every value, each time in any order
  /// @returns NaN without values
  template <typename ForEach>
  [[nodiscard]] static double of(const ForEach& for_each) {
    std::uint64_t count = 0;
    std::vector<std::uint64_t> kept;
    for_each([&](double value) {
      if (count++ < few) kept.push_back(ordered_bits(value));
    });
    if (count == 0) return std::numeric_limits<double>::quiet_NaN();
    if (count <= few) return middle_of(kept);
    std::array<Searched, 2> middle{Searched{.rank = (count - 1) / 2}, Searched{.rank = count / 2}};
    unsigned known_bits = 0;
    for (const unsigned bits : {16U, 16U, 16U, 16U}) {
      for (Searched& one : middle) one.counts.assign(std::size_t{1} << bits, 0);
      for_each([&](double value) {
        const std::uint64_t ordered = ordered_bits(value);
        for (Searched& one : middle) {
          if (known_bits > 0 && ordered >> (64U - known_bits) != one.prefix) continue;
          ++one.counts[(ordered << known_bits) >> (64U - bits)];
        }
      });
      for (Searched& one : middle) one.narrow(bits);
      known_bits += bits;
    }
    return 0.5 * (value_of_ordered(middle[0].prefix) + value_of_ordered(middle[1].prefix));
  }

 private:
  static constexpr std::size_t few = std::size_t{1} << 17U;

  static double middle_of(std::vector<std::uint64_t>& values) {
    const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), upper, values.end());
    const std::uint64_t lower = values.size() % 2 == 1 ? *upper : *std::max_element(values.begin(), upper);
    return 0.5 * (value_of_ordered(lower) + value_of_ordered(*upper));
  }

  struct Searched {
    std::uint64_t rank = 0;    ///< among those that begin with
    std::uint64_t prefix = 0;  ///< these bits
    std::vector<std::uint64_t> counts{};

    void narrow(unsigned bits) {
      std::size_t bin = 0;
      while (rank >= counts[bin]) rank -= counts[bin++];
      prefix = (prefix << bits) | bin;
    }
  };
};

}  // namespace kerf::bench

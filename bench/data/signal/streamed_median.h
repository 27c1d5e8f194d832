#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "signal/ordered_bits.h"

namespace kerf::bench {

/// The median of values that are gone through three times instead of being kept: exactly what median() gives,
/// in 64 MB however many there are.
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
    for_each([&](double) { ++count; });
    if (count == 0) return std::numeric_limits<double>::quiet_NaN();
    std::array<Searched, 2> middle{Searched{.rank = (count - 1) / 2}, Searched{.rank = count / 2}};
    unsigned known_bits = 0;
    for (const unsigned bits : {22U, 21U, 21U}) {
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

#pragma once

#include <bit>
#include <cstdint>

namespace kerf::bench {

/// A number as bits that are ordered as numbers are, those that are none at the ends.
[[nodiscard]] constexpr std::uint64_t ordered_bits(double value) noexcept {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

/// The number that has them.
[[nodiscard]] constexpr double value_of_ordered(std::uint64_t bits) noexcept {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
  return std::bit_cast<double>((bits & sign) != 0 ? bits & ~sign : ~bits);
}

}  // namespace kerf::bench

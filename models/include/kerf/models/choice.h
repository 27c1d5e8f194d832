#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <kerf/models/parameter.h>

namespace kerf::models {

// What a law asks of its numbers where only a number depends on the answer. Where the law goes another way it
// says if. The difference matters to who writes the law out for another program (kerf/traced/traced.h), which
// has functions of these names for its own scalar.

/// Of two numbers the one that the condition names.
template <typename T>
[[nodiscard]] inline T chosen(bool condition, const T& yes, const T& no) noexcept {
  return condition ? yes : no;
}
/// As std::min() and std::max(), of equal ones the first.
template <typename T>
[[nodiscard]] inline T lesser(const T& a, const T& b) noexcept {
  return chosen(b < a, b, a);
}
template <typename T>
[[nodiscard]] inline T greater(const T& a, const T& b) noexcept {
  return chosen(a < b, b, a);
}

/// Takes a number for zero where it is smaller than a bound.
template <typename T>
inline void let_go(T& number, const Input<T>& bound) noexcept {
  if (number < bound && number > -bound) number = T(0);
}

/// A whole number >= 0 as a place in a table.
[[nodiscard]] inline std::size_t place_of(double whole) noexcept { return static_cast<std::size_t>(whole); }
/// What stands in a table at a place, or `further` behind it.
template <typename Table>
[[nodiscard]] inline const auto& entry(const Table& table, std::size_t place,
                                       std::size_t further = 0) noexcept {
  return table[place + further];
}
/// Place of the first of the segments between `knots` increasing knots that does not end before x; of none,
/// the last.
template <typename T, std::size_t N>
[[nodiscard]] inline std::size_t segment_of(const std::array<T, N>& knot, std::size_t knots,
                                            const Input<T>& x) noexcept {
  std::size_t i = 0;
  while (i + 2 < knots && knot[i + 1] < x) ++i;
  return i;
}

/// A number rounded to a whole one, to count by.
[[nodiscard]] inline std::uint64_t count_of(double number) noexcept {
  return static_cast<std::uint64_t>(std::round(number));
}

}  // namespace kerf::models

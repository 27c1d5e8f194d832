#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace kerf::bench {

/// Appends the digits from `at` on to `value`, and returns where they end. More than 19 of them overflow.
inline const char* take_digits(const char* at, const char* end, std::uint64_t& value) noexcept {
  while (at != end && static_cast<unsigned char>(*at - '0') < 10) {
    value = value * 10 + static_cast<std::uint64_t>(*at++ - '0');
  }
  return at;
}

/// Reads a decimal number without a sign by std::from_chars; `begin` if there is none. A number beyond the
/// range of a double becomes infinity or zero.
inline const char* parse_any_decimal(const char* begin, const char* end, char point, double& value) noexcept {
  std::array<char, 128> copy;  // from_chars knows only the point
  const char* from = begin;
  const char* to = end;
  if (point != '.') {
    to = std::transform(begin, begin + std::min<std::ptrdiff_t>(end - begin, copy.size()), copy.begin(),
                        [point](char c) { return c == point ? '.'
                                                 : c == '.' ? point
                                                            : c; });
    from = copy.data();
  }
  if (from == to || *from == '-') return begin;
  const auto [stop, error] = std::from_chars(from, to, value);
  if (error == std::errc::invalid_argument) return begin;
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(from, stop).c_str(), nullptr);
  return begin + (stop - from);
}

/// Reads a decimal number at the start of [begin, end) and returns where it ends, or `begin` if there is
/// none.
///
/// The result is the double nearest to the text, as std::from_chars gives it: digits that make an integer
/// below 2^53, with a power of ten up to 22, are one exact number times or divided by another, which IEEE
/// arithmetic rounds correctly; anything else goes to std::from_chars. Accepts a leading `+`, `nan` and
/// `inf`. `point` is '.' or ','.
inline const char* parse_decimal(const char* begin, const char* end, char point, double& value) noexcept {
  static constexpr std::array<double, 23> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr std::ptrdiff_t digits_that_fit = 19;
  constexpr std::uint64_t exact_below = std::uint64_t{1} << 53U;
  const bool negative = begin != end && *begin == '-';
  const char* const number = begin != end && (*begin == '-' || *begin == '+') ? begin + 1 : begin;

  std::uint64_t digits = 0;
  const char* at = take_digits(number, end, digits);
  std::ptrdiff_t count = at - number;
  std::ptrdiff_t power = 0;
  if (at != end && *at == point) {
    const char* const decimals = ++at;
    at = take_digits(decimals, end, digits);
    power = decimals - at;
    count -= power;
  }
  if (count > 0 && at != end && (*at == 'e' || *at == 'E')) {
    const bool has_sign = at + 1 != end && (at[1] == '-' || at[1] == '+');
    const char* const exponent = at + (has_sign ? 2 : 1);
    std::uint64_t tens = 0;
    const char* const stop = take_digits(exponent, end, tens);
    if (stop != exponent) at = stop;
    if (stop - exponent > 4) tens = 9999;
    power += has_sign && exponent[-1] == '-' ? -static_cast<std::ptrdiff_t>(tens)
                                             : static_cast<std::ptrdiff_t>(tens);
  }
  double magnitude = 0.0;
  if (count > 0 && count <= digits_that_fit && digits < exact_below && power >= -22 && power <= 22) {
    const double ten = powers[static_cast<std::size_t>(power < 0 ? -power : power)];
    magnitude = power < 0 ? static_cast<double>(digits) / ten : static_cast<double>(digits) * ten;
  } else {
    at = parse_any_decimal(number, end, point, magnitude);
    if (at == number) return begin;
  }
  value = negative ? -magnitude : magnitude;
  return at;
}

}  // namespace kerf::bench

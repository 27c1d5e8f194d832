#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>

namespace kerf::bench {

/// Reads a decimal number at the start of [begin, end) and returns where it ends, or `begin` if there is
/// none.
///
/// The result is the double nearest to the text, as std::from_chars gives it: a number of up to 15 digits
/// with a power of ten up to 22 is one exact integer times or divided by one exact power, which IEEE
/// arithmetic rounds correctly; anything longer goes to std::from_chars. Accepts a leading `+`, `nan` and
/// `inf`. `point` is '.' or ','.
inline const char* parse_decimal(const char* begin, const char* end, char point, double& value) noexcept {
  static constexpr std::array<double, 23> powers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const char* at = begin;
  const bool negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  const char* const unsigned_begin = at;

  std::uint64_t digits = 0;
  std::ptrdiff_t count = 0;
  const auto take_digits = [&] {
    const char* const first = at;
    while (at != end && static_cast<unsigned char>(*at - '0') < 10) {
      digits = digits * 10 + static_cast<std::uint64_t>(*at++ - '0');
    }
    count += at - first;
    return at - first;
  };
  take_digits();
  std::ptrdiff_t decimals = 0;
  if (at != end && *at == point) {
    ++at;
    decimals = take_digits();
  }
  const bool has_exponent = at != end && (*at == 'e' || *at == 'E') && count > 0;
  if (count > 0 && count <= 15 && !has_exponent) {
    const double exact = static_cast<double>(digits) / powers[static_cast<std::size_t>(decimals)];
    value = negative ? -exact : exact;
    return at;
  }

  std::array<char, 64> copy;  // from_chars knows only the point, and no plus
  std::size_t length = 0;
  for (const char* c = unsigned_begin; c != end && length < copy.size(); ++c) {
    copy[length++] = *c == point ? '.' : (*c == '.' ? ',' : *c);
  }
  double magnitude = 0.0;
  const auto [stop, error] = std::from_chars(copy.data(), copy.data() + length, magnitude);
  if (error != std::errc{} || copy[0] == '-') return begin;
  value = negative ? -magnitude : magnitude;
  return unsigned_begin + (stop - copy.data());
}

}  // namespace kerf::bench

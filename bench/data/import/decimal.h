#pragma once

#include <string_view>

#include <fast_float/fast_float.h>

namespace kerf::bench {

/// Reads a decimal number at the start of [begin, end) and returns where it ends, or `begin` if there is
/// none: the double nearest to the text, infinity or zero beyond the range of a double. Accepts a leading
/// `+`, `nan` and `inf`. `point` is '.' or ','.
inline const char* parse_decimal(const char* begin, const char* end, char point, double& value) noexcept {
  const bool plus = begin != end && *begin == '+';
  const char* const number = plus ? begin + 1 : begin;
  if (plus && number != end && *number == '-') return begin;
  const fast_float::parse_options options(fast_float::chars_format::general, point);
  const auto [stop, error] = fast_float::from_chars_advanced(number, end, value, options);
  return error == std::errc::invalid_argument ? begin : stop;
}

/// Whether a whole field is a decimal number.
inline bool is_decimal(std::string_view field, char point) noexcept {
  double value = 0.0;
  const char* const end = field.data() + field.size();
  return !field.empty() && parse_decimal(field.data(), end, point, value) == end;
}

}  // namespace kerf::bench

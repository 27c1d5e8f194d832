#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "formats/tdms/tdms_segments.h"

// The values of a TDMS file, one after the other: of tdms_segments.cpp alone.

namespace kerf::bench::tdms {

enum Type : std::uint32_t {
  type_i8 = 1,
  type_i64 = 4,
  type_u8 = 5,
  type_u64 = 8,
  type_float = 9,
  type_double = 10,
  type_extended = 11,
  type_float_with_unit = 0x19,
  type_double_with_unit = 0x1A,
  type_string = 0x20,
  type_bool = 0x21,
  type_time = 0x44,
  type_complex_float = 0x08000C,
  type_complex_double = 0x10000D
};

/// Bytes of a value; 0 of a type that has none, or that nobody knows.
inline std::uint64_t size_of(std::uint32_t type) {
  switch (type) {
    case type_i8:
    case type_u8:
    case type_bool:
      return 1;
    case 2:
    case 6:
      return 2;
    case 3:
    case 7:
    case type_float:
    case type_float_with_unit:
      return 4;
    case type_i64:
    case type_u64:
    case type_double:
    case type_double_with_unit:
    case type_complex_float:
      return 8;
    case type_extended:
    case type_time:
    case type_complex_double:
      return 16;
    default:
      return 0;
  }
}

/// The bytes from a place on, in the order of a segment.
class Cursor {
 public:
  Cursor(std::string_view bytes, std::size_t at, std::size_t end, bool big_endian, const std::string& name)
      : bytes_(bytes.substr(0, end)), at_(at), big_endian_(big_endian), name_(name) {}

  template <typename T>
  T take() {
    const std::string_view raw = take_bytes(sizeof(T));
    std::array<char, sizeof(T)> copy{};
    std::ranges::copy(raw, copy.begin());
    if (big_endian_) std::ranges::reverse(copy);
    return std::bit_cast<T>(copy);
  }
  std::string_view take_bytes(std::uint64_t count) {
    if (count > bytes_.size() - at_) refuse(fmt::format("says {} bytes more than there are", count));
    const std::string_view raw = bytes_.substr(at_, count);
    at_ += count;
    return raw;
  }
  std::string take_text() { return std::string(take_bytes(take<std::uint32_t>())); }
  TdmsMoment take_moment() {
    TdmsMoment moment;
    if (big_endian_) {
      moment.seconds = take<std::int64_t>();
      moment.fractions = take<std::uint64_t>();
    } else {
      moment.fractions = take<std::uint64_t>();
      moment.seconds = take<std::int64_t>();
    }
    return moment;
  }
  double take_number(std::uint32_t type) {
    switch (type) {
      case type_i8:
        return take<std::int8_t>();
      case 2:
        return take<std::int16_t>();
      case 3:
        return take<std::int32_t>();
      case type_i64:
        return static_cast<double>(take<std::int64_t>());
      case type_u8:
      case type_bool:
        return take<std::uint8_t>();
      case 6:
        return take<std::uint16_t>();
      case 7:
        return take<std::uint32_t>();
      case type_u64:
        return static_cast<double>(take<std::uint64_t>());
      case type_float:
      case type_float_with_unit:
        return static_cast<double>(take<float>());
      default:
        return take<double>();
    }
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw std::invalid_argument(fmt::format("{}: a damaged TDMS file: at byte {} it {}", name_, at_, why));
  }

 private:
  std::string_view bytes_;
  std::size_t at_;
  bool big_endian_;
  const std::string& name_;
};

}  // namespace kerf::bench::tdms

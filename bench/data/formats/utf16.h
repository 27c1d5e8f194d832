#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::bench {

enum class Utf16 : std::uint8_t { little_endian, big_endian };

/// Whether text is UTF-16: by its byte order mark, or, without one, because every second byte of its first
/// thousand characters is zero in nine of ten and hardly any other is, as in numbers.
[[nodiscard]] std::optional<Utf16> utf16_order(std::string_view bytes) noexcept;

/// @throws std::invalid_argument that names the byte at which it is none.
[[nodiscard]] std::string utf8_of_utf16(std::string_view bytes, Utf16 order, const std::string& name);

}  // namespace kerf::bench

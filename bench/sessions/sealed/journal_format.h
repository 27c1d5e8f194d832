#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include "sealed/blake2b.h"

/// Sizes and marks of FILE.journal; journal.h says what they are for.
namespace kerf::bench::journal_format {

inline constexpr std::string_view head_mark = "KERFJRN1";
inline constexpr std::string_view record_mark = "KERFENT1";
inline constexpr std::size_t uuid_size = 36;
inline constexpr std::size_t check_size = 16;
/// Mark, uuid, number of the first entry, checksum of these; and the process.
inline constexpr std::size_t head_size = 8 + uuid_size + 8 + check_size + 8;
inline constexpr std::size_t pid_at = head_size - 8;
/// Mark, length of the body, checksum of the body; and the checksum of these.
inline constexpr std::size_t record_head_size = 8 + 8 + 2 * check_size;

[[nodiscard]] inline std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

[[nodiscard]] inline std::span<const std::uint8_t> check_of(const Digest& digest) {
  return std::span<const std::uint8_t>(digest).first(check_size);
}

}  // namespace kerf::bench::journal_format

#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace kerf::bench {

using Digest = std::array<std::uint8_t, 32>;

/// BLAKE2b of 256 bits of the parts, one after the other [RFC7693].
[[nodiscard]] Digest blake2b(std::initializer_list<std::span<const std::uint8_t>> parts);

}  // namespace kerf::bench

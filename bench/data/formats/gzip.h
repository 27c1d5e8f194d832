#pragma once

#include <string>
#include <string_view>

#include "formats/unpacked_limits.h"

namespace kerf::bench {

[[nodiscard]] bool is_gzip(std::string_view bytes) noexcept;

/// What gzip packed, all members of it one after the other [RFC1952]; zeros after the last are padding.
/// @throws std::invalid_argument for what is cut short, damaged or too large.
[[nodiscard]] std::string gunzip(std::string_view bytes, const UnpackedLimits& limits);

}  // namespace kerf::bench

#pragma once

#include <numbers>

namespace kerf {

/// One degree in radians: 30 degree is an angle in SI.
inline constexpr double degree = std::numbers::pi / 180.0;

}  // namespace kerf

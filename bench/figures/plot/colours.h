#pragma once

#include <string_view>

#include "plot/plot.h"

namespace kerf::bench {

/// "#0072B2"
[[nodiscard]] std::string_view hex_of(Colour colour) noexcept;

}  // namespace kerf::bench

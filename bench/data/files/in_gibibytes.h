#pragma once

#include <cstdint>
#include <string>

#include <fmt/core.h>

namespace kerf::bench {

/// "1.25 GiB"; what is less than a hundredth of one in MiB.
inline std::string in_gibibytes(std::uintmax_t bytes) {
  constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
  if (static_cast<double>(bytes) < 0.01 * gibibyte)
    return fmt::format("{:.1f} MiB", 1024.0 * static_cast<double>(bytes) / gibibyte);
  return fmt::format("{:.2f} GiB", static_cast<double>(bytes) / gibibyte);
}

}  // namespace kerf::bench

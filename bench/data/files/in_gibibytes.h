#pragma once

#include <cstdint>
#include <string>

#include <fmt/core.h>

namespace kerf::bench {

inline std::string in_gibibytes(std::uintmax_t bytes) {
  constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
  return fmt::format("{:.2f} GiB", static_cast<double>(bytes) / gibibyte);
}

}  // namespace kerf::bench

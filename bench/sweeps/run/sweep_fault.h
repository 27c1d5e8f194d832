#pragma once

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

namespace kerf::bench {

/// Whether KERF_SWEEP_FAULT, which trials set, has "NAME@NUMBER" among what it lists.
[[nodiscard]] inline bool is_fault(std::string_view name, std::uint64_t number) {
  static const char* const faults = std::getenv("KERF_SWEEP_FAULT");
  if (faults == nullptr) return false;
  const std::string wanted = fmt::format(",{}@{},", name, number);
  return fmt::format(",{},", faults).find(wanted) != std::string::npos;
}

}  // namespace kerf::bench

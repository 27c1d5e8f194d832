#pragma once

#include <cstddef>

namespace kerf::test {

/// How often this thread has allocated since it started. Counted in programs that link
/// allocation_counter.cpp.
[[nodiscard]] std::size_t allocations() noexcept;

}  // namespace kerf::test

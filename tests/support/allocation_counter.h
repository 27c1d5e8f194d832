#pragma once

#include <cstddef>

namespace kerf::test {

// In programs that link allocation_counter.cpp.

/// How often this thread has allocated since it started.
[[nodiscard]] std::size_t allocations() noexcept;

/// While it lives, an allocation by this thread aborts the program. Other threads may allocate.
class NoAllocation {
 public:
  NoAllocation() noexcept;
  NoAllocation(const NoAllocation&) = delete;
  NoAllocation& operator=(const NoAllocation&) = delete;
  ~NoAllocation();
};

}  // namespace kerf::test

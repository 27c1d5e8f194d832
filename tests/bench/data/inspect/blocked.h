#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "signal/blocked_values.h"

namespace kerf::test {

/// Values seen block by block, as those of a file are; they have to stay where they are.
inline bench::BlockedValues blocked(const std::vector<double>& values) {
  return {values.size(), [&values](std::uint64_t first, std::span<double> some) {
            std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), some.size(), some.begin());
          }};
}

}  // namespace kerf::test

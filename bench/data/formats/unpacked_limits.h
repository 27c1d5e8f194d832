#pragma once

#include <cstddef>
#include <string>

namespace kerf::bench {

/// A packed file in messages, and how much may be in it: a small file can hold a very large one.
struct UnpackedLimits {
  std::string name;
  std::size_t at_most = 0;  ///< bytes, of all that is unpacked
};

}  // namespace kerf::bench

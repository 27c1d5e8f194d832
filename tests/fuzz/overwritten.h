#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "fuzz/target.h"

namespace kerf::fuzz {

/// What is left of a sound file once pieces of it are overwritten: each is where, how long and what.
[[nodiscard]] inline std::string overwritten(std::string whole, Bytes pieces) {
  while (pieces.size() > 3) {
    const std::size_t at = (pieces[0] * 256U + pieces[1]) % whole.size();
    const std::size_t length =
        std::min({1 + pieces[2] % std::size_t{16}, pieces.size() - 3, whole.size() - at});
    std::memcpy(whole.data() + at, pieces.data() + 3, length);
    pieces = pieces.subspan(3 + length);
  }
  return whole;
}

}  // namespace kerf::fuzz

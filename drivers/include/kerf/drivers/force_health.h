#pragma once

#include <cstdint>

namespace kerf::drivers {

/// What a force sensor says of the wrench that it has just sent.
enum class ForceHealth : std::uint8_t {
  sound,
  doubted,  ///< an error that the wrench may suffer from
  overload
};

}  // namespace kerf::drivers

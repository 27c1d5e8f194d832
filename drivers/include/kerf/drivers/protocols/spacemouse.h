#pragma once

#include <array>
#include <cstdint>
#include <span>

/// 3Dconnexion SpaceNavigator and its family on the wire: HID reports, first byte their number. Pure
/// functions.
///
/// Report 1: x, y, z, and on newer models all six axes at once; report 2: rx, ry, rz; report 3: buttons.
/// Numbers are little-endian, 16 bits, about +-350; +x is right, +y towards the user, +z down. A Navigator
/// sends each report 62.5 times a second at most.
namespace kerf::drivers::spacemouse {

struct State {
  std::array<int, 6> axis{};  ///< x, y, z, rx, ry, rz as sent
  std::uint32_t buttons = 0;

  friend bool operator==(const State&, const State&) = default;
};

/// Takes a report into the state; false, and no change, for one that is unknown or too short.
bool take_report(std::span<const std::uint8_t> bytes, State& state) noexcept;

}  // namespace kerf::drivers::spacemouse

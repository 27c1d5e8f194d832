#include "kerf/drivers/protocols/spacemouse.h"

#include <cstddef>

namespace kerf::drivers::spacemouse {
namespace {

constexpr std::uint8_t translation = 1;
constexpr std::uint8_t rotation = 2;
constexpr std::uint8_t pressed = 3;

void take_axes(std::span<const std::uint8_t> bytes, State& state, std::size_t first,
               std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    state.axis[first + i] =
        static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[1 + 2 * i] | (bytes[2 + 2 * i] << 8U)));
  }
}

}  // namespace

bool take_report(std::span<const std::uint8_t> bytes, State& state) noexcept {
  if (bytes.empty()) return false;
  constexpr std::size_t three = 7;
  constexpr std::size_t six = 13;
  if (bytes[0] == translation && bytes.size() >= six) {
    take_axes(bytes, state, 0, 6);
    return true;
  }
  if ((bytes[0] == translation || bytes[0] == rotation) && bytes.size() >= three) {
    take_axes(bytes, state, bytes[0] == translation ? 0 : 3, 3);
    return true;
  }
  if (bytes[0] == pressed && bytes.size() >= 2) {
    state.buttons = 0;
    for (std::size_t i = 1; i < bytes.size() && i <= 4; ++i) {
      state.buttons |= static_cast<std::uint32_t>(bytes[i]) << (8 * (i - 1));
    }
    return true;
  }
  return false;
}

}  // namespace kerf::drivers::spacemouse

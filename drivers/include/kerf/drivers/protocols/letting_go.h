#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kerf::drivers {

/// What makes a device let its motors go, as data that a process without its driver can send: transfers one
/// after the other, and the whole list so many times.
struct LettingGo {
  static constexpr std::size_t max_size = 64;
  static constexpr std::size_t max_transfers = 4;

  struct Transfer {
    std::uint8_t endpoint = 0;  ///< with bit 7 set it receives, and what comes is dropped
    std::uint8_t size = 0;      ///< at most max_size
    std::array<std::uint8_t, max_size> bytes{};
  };
  std::array<Transfer, max_transfers> transfers{};
  std::uint8_t count = 0;  ///< of the transfers, at most max_transfers
  std::uint8_t rounds = 0;

  /// Bytes beyond max_size are left out.
  constexpr void send(std::uint8_t endpoint, std::span<const std::uint8_t> bytes) noexcept {
    Transfer& one = transfers[count++];
    one = {.endpoint = endpoint, .size = static_cast<std::uint8_t>(std::min(bytes.size(), max_size))};
    std::copy_n(bytes.begin(), one.size, one.bytes.begin());
  }
  constexpr void receive(std::uint8_t endpoint, std::size_t size) noexcept {
    transfers[count++] = {.endpoint = endpoint, .size = static_cast<std::uint8_t>(std::min(size, max_size))};
  }
};

}  // namespace kerf::drivers

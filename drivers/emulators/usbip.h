#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "emulated_device.h"

/// USB/IP on the wire, version 1.1.1: pure functions. Numbers are big-endian. Source: [usbip].
namespace kerf::emulators::usbip {

inline constexpr std::size_t header_size = 48;  ///< of every message of an attached device
inline constexpr std::uint16_t default_port = 3240;

/// What the host asks of an attached device.
struct Request {
  enum class Kind : std::uint8_t { submit, unlink };
  Kind kind = Kind::submit;
  std::uint32_t sequence = 0;
  std::uint32_t device = 0;
  bool in = false;  ///< to the host
  std::uint8_t endpoint = 0;
  std::uint32_t length = 0;             ///< submit: of the buffer
  std::array<std::uint8_t, 8> setup{};  ///< submit to endpoint 0
  std::uint32_t unlinked = 0;           ///< unlink: sequence of the transfer to end
};
/// Nothing for a command, endpoint or length that there is not.
[[nodiscard]] std::optional<Request> parse_request(
    std::span<const std::uint8_t, header_size> header) noexcept;
[[nodiscard]] std::array<std::uint8_t, header_size> encode(const Request& request) noexcept;

/// The answer to a submit: status 0 or a negative error number, `actual` bytes moved; data follow if it was
/// IN.
[[nodiscard]] std::array<std::uint8_t, header_size> submit_reply(std::uint32_t sequence, std::int32_t status,
                                                                 std::uint32_t actual) noexcept;
/// The answer to an unlink: -ECONNRESET if the transfer was ended by it, 0 if it had ended before.
[[nodiscard]] std::array<std::uint8_t, header_size> unlink_reply(std::uint32_t sequence,
                                                                 std::int32_t status) noexcept;

/// Before a device is attached, on a connection of its own: the list, or a wish for one device.
inline constexpr std::size_t operation_size = 8;
inline constexpr std::size_t bus_id_size = 32;
inline constexpr const char* bus_id = "1-1";
enum class Operation : std::uint16_t { list = 0x8005, import = 0x8003 };
[[nodiscard]] std::optional<Operation> parse_operation(
    std::span<const std::uint8_t, operation_size> bytes) noexcept;
[[nodiscard]] Bytes list_reply(const Description& device);
/// `granted` false: there is no such device, or it is attached already.
[[nodiscard]] Bytes import_reply(const Description& device, bool granted);

}  // namespace kerf::emulators::usbip

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kerf::emulators {

using Bytes = std::vector<std::uint8_t>;

/// As the device tells it: descriptors byte for byte.
struct Description {
  enum class Speed : std::uint8_t { low = 1, full = 2, high = 3 };  ///< as USB/IP numbers them

  Speed speed = Speed::full;
  Bytes device;                      ///< 18 bytes
  Bytes configuration;               ///< with its interfaces and endpoints
  std::vector<std::string> strings;  ///< from index 1 on
  std::vector<Bytes> reports;        ///< HID report descriptor of each interface; empty: not HID

  [[nodiscard]] std::uint16_t vendor() const {
    return static_cast<std::uint16_t>(device[8] | device[9] << 8);
  }
  [[nodiscard]] std::uint16_t product() const {
    return static_cast<std::uint16_t>(device[10] | device[11] << 8);
  }
};

/// The eight bytes that begin a control transfer.
struct Setup {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;

  [[nodiscard]] static Setup parse(std::span<const std::uint8_t, 8> bytes) noexcept;
};

/// What goes wrong on the wire, when the server asks for it.
enum class Disturbance : std::uint8_t { none, drop, split, corrupt };

/// A device as its emulator plays it. The server answers the standard requests from the description, keeps
/// the waiting transfers of each endpoint in order, and asks for data whenever time passes or the host has
/// sent something. Times are nanoseconds of the monotonic clock and never go back.
class EmulatedDevice {
 public:
  EmulatedDevice() = default;
  EmulatedDevice(const EmulatedDevice&) = delete;
  EmulatedDevice& operator=(const EmulatedDevice&) = delete;
  virtual ~EmulatedDevice() = default;

  [[nodiscard]] virtual const Description& description() const = 0;

  /// A class or vendor request. Returns what is sent back (nothing to send: empty), or no value to stall.
  virtual std::optional<Bytes> control(const Setup& setup, std::span<const std::uint8_t> data,
                                       std::int64_t now_ns) = 0;

  /// The host has sent `bytes` to an endpoint (1 to 15).
  virtual void receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, std::int64_t now_ns) = 0;

  /// The oldest transfer that waits on an IN endpoint (1 to 15), waiting since `waits_since_ns` or since the
  /// one before it ended: fills `buffer` and returns how much it was; nothing to let it wait on. What is
  /// returned must not be more than the buffer holds. `next` disturbs this answer if there is one with data:
  /// dropped, cut in two answers, a byte turned; it is set to none once that has been done.
  virtual std::optional<std::size_t> send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                          std::int64_t waits_since_ns, std::int64_t now_ns,
                                          Disturbance& next) = 0;

  /// When send() may have something new to say although the host does nothing; nothing: never. Asked only
  /// while a transfer waits: what the device does by itself in between, it makes up for when it is next
  /// asked.
  [[nodiscard]] virtual std::optional<std::int64_t> next_event_ns(std::int64_t now_ns) const = 0;

  /// Bytes that each packet to the host begins with before its data, if it has any.
  [[nodiscard]] virtual std::size_t preamble() const { return 0; }

  /// From now on its counters say what they said last, or again what they count.
  virtual void stick(bool /*stuck*/) {}

  /// One line of what it has seen, for the person who watches.
  [[nodiscard]] virtual std::string tell() const { return ""; }
};

}  // namespace kerf::emulators

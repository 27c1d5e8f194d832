#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kerf::drivers {

/// A serial port with 8 data bits, no parity, one stop bit, bytes as they come; this program's alone while it
/// is open. Where the driver of an adapter knows of it, it hands bytes over without waiting for more.
class SerialPort {
 public:
  /// @param baud one of those that Linux names, 9600 to 4000000
  /// @throws std::runtime_error that says what stands in the way and what mends it.
  SerialPort(const std::string& path, unsigned baud);
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;
  ~SerialPort();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  /// Does not wait; false where not all of it was taken.
  bool send(std::span<const std::uint8_t> bytes) const noexcept;
  bool send(std::string_view text) const noexcept;
  /// What has arrived, as much as the buffer holds; 0: nothing. -1: the port is gone.
  [[nodiscard]] std::ptrdiff_t receive(std::span<std::uint8_t> buffer) const noexcept;
  /// The same, but waits at most so long for the first byte.
  [[nodiscard]] std::ptrdiff_t receive_within(std::span<std::uint8_t> buffer, int most_ms) const noexcept;
  /// Forgets what has arrived and was not read.
  void forget() const noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace kerf::drivers

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kerf::drivers {

/// Bytes from a TCP port of another machine.
class ByteStream {
 public:
  /// @throws std::system_error, also where nobody answers in time.
  ByteStream(const std::string& address, std::uint16_t port, std::chrono::milliseconds patience);
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  ~ByteStream();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  /// What has arrived, as much as the buffer holds; 0: nothing. -1: the other end is gone.
  [[nodiscard]] std::ptrdiff_t receive(std::span<std::uint8_t> buffer) const noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace kerf::drivers

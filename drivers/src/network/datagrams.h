#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace kerf::drivers {

/// The IPv4 address of a host's name, or of an address: "192.168.1.1".
/// @throws std::runtime_error that says why there is none.
[[nodiscard]] std::string address_of(const std::string& host);

/// Datagrams to and from one UDP port of one machine; what others send does not arrive.
class Datagrams {
 public:
  /// @throws std::system_error
  Datagrams(const std::string& address, std::uint16_t port);
  Datagrams(const Datagrams&) = delete;
  Datagrams& operator=(const Datagrams&) = delete;
  ~Datagrams();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  /// False where the system did not take it.
  bool send(std::span<const std::uint8_t> bytes) const noexcept;
  /// One that has arrived: its size, which may be more than the buffer's and was then cut; nothing if none
  /// waits.
  [[nodiscard]] std::optional<std::size_t> receive(std::span<std::uint8_t> buffer) noexcept;
  /// Whether the other machine has said, last of all, that nobody listens there.
  [[nodiscard]] bool refused() const noexcept { return refused_; }

 private:
  int descriptor_ = -1;
  bool refused_ = false;
};

/// A name that one program of this machine has at a time, for a device that serves one. It ends with the
/// program, whatever ends that.
class SoleUse {
 public:
  /// @throws std::runtime_error if another program has it.
  explicit SoleUse(const std::string& name);
  SoleUse(const SoleUse&) = delete;
  SoleUse& operator=(const SoleUse&) = delete;
  ~SoleUse();

 private:
  int descriptor_ = -1;
};

}  // namespace kerf::drivers

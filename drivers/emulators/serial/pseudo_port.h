#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace kerf::emulators {

/// The device's end of a serial line without a wire: a pseudo-terminal, whose other end is a port with a
/// path.
class PseudoPort {
 public:
  /// @param link a symbolic link to the port, made anew; empty: none
  /// @throws std::system_error
  explicit PseudoPort(std::string link);
  PseudoPort(const PseudoPort&) = delete;
  PseudoPort& operator=(const PseudoPort&) = delete;
  ~PseudoPort();

  /// Of the other end, which a host opens.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  /// Whether a host has it open.
  [[nodiscard]] bool is_open() const noexcept;
  [[nodiscard]] std::ptrdiff_t receive(std::span<std::uint8_t> buffer) const noexcept;
  /// What does not fit is lost, as on a line that nobody reads.
  void send(std::span<const std::uint8_t> bytes) const noexcept;
  /// As pulled out: the host's end is dead from now on.
  void pull_out() noexcept;

 private:
  int descriptor_ = -1;
  std::string path_;
  std::string link_;
};

}  // namespace kerf::emulators

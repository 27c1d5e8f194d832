#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>

#include "emulated_device.h"

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

/// What a device says on a serial line, at the pace of its speed: ten bits a byte.
class PacedLine {
 public:
  explicit PacedLine(double baud) noexcept : baud_(baud) {}

  void say(Bytes bytes, std::int64_t now_ns);
  /// What has passed the line by now is at the other end.
  void send_due(const PseudoPort& port, std::int64_t now_ns);
  /// When something of it is due; nothing waits: `otherwise`.
  [[nodiscard]] std::int64_t next_ns(std::int64_t otherwise) const noexcept {
    return on_the_way_.empty() ? otherwise : on_the_way_.front().due_ns;
  }
  void clear() noexcept { on_the_way_.clear(); }

 private:
  struct OnTheWay {
    std::int64_t due_ns;
    Bytes bytes;
  };
  double baud_;
  std::deque<OnTheWay> on_the_way_;
  std::int64_t free_ns_ = 0;  ///< when the line is
};

/// Something that is played on a pseudo-terminal.
class EmulatedOnLine {
 public:
  EmulatedOnLine() = default;
  EmulatedOnLine(const EmulatedOnLine&) = delete;
  EmulatedOnLine& operator=(const EmulatedOnLine&) = delete;
  virtual ~EmulatedOnLine() = default;

  [[nodiscard]] virtual const std::string& path() const noexcept = 0;
  /// Until `stop`, its `unplug`, or so many seconds (0: never).
  virtual void run(const std::atomic<bool>& stop, double seconds) = 0;
  [[nodiscard]] virtual std::string tell() const = 0;
};

}  // namespace kerf::emulators

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "emulated_device.h"

namespace kerf::emulators {

/// The serial bridge of FTDI (FT232) that many devices hang on: its vendor requests, and the way in which
/// what arrives on the line becomes packets.
///
/// Each packet to the host begins with two bytes of modem and line status, 01 60, and carries at most 62
/// more. A transfer is answered when 62 bytes wait, or when the latency timer expires, with whatever is
/// there, perhaps the status alone. The timer starts with the transfer or with the end of the one before,
/// whichever is later. A transfer longer than a packet has the two bytes again every 64.
class Ftdi {
 public:
  static constexpr std::size_t status_size = 2;  ///< before the data of each packet

  /// What the device behind it learns from a request.
  enum class Event : std::uint8_t { none, purged, baud, dtr_rose, dtr_fell, reset };

  /// A vendor request: what is sent back (nothing: empty), or no value for one that there is not.
  std::optional<Bytes> control(const Setup& setup, Event& event);

  /// Bytes from the line that are there from `ready_ns` on, together. Times must not go back.
  void put(std::span<const std::uint8_t> bytes, std::int64_t ready_ns);

  /// As EmulatedDevice::send(). `corrupt` loses one byte of the data.
  std::optional<std::size_t> send(std::span<std::uint8_t> buffer, std::int64_t waits_since_ns,
                                  std::int64_t now_ns, Disturbance& next);
  /// When the transfer that send() last let wait will be answered.
  [[nodiscard]] std::optional<std::int64_t> next_event_ns() const noexcept { return due_ns_; }

  [[nodiscard]] double baud() const noexcept { return baud_; }
  /// How long so many bytes take on the line, at ten bits each.
  [[nodiscard]] std::int64_t line_time_ns(std::size_t bytes) const noexcept {
    return static_cast<std::int64_t>(1e10 * static_cast<double>(bytes) / baud_);
  }
  /// A purge, and how many bytes it and disturbances have lost.
  void purge() noexcept;
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

 private:
  struct Arrival {
    std::int64_t ready_ns;
    std::uint8_t byte;
  };
  [[nodiscard]] std::size_t waiting(std::int64_t now_ns) const noexcept;
  std::size_t fill(std::span<std::uint8_t> buffer, std::size_t data);

  std::deque<Arrival> line_;  ///< towards the host
  std::int64_t latency_ns_ = 16'000'000;
  std::optional<std::int64_t> due_ns_;
  std::int64_t answered_ns_ = -1;  ///< when the last transfer was
  std::int64_t meant_ns_ = -1;     ///< when it should have been
  double baud_ = 9600.0;
  bool dtr_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace kerf::emulators

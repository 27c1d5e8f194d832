#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "emulated_device.h"

namespace kerf::emulators {

/// The way of HID reports to the host, on which one may be dropped, torn in two behind its third byte, or
/// have a bit turned.
class ReportWire {
 public:
  /// Bytes are counted from 0; the one that a disturbance turns a bit of.
  explicit ReportWire(std::size_t turned_byte) : turned_byte_(turned_byte) {}

  /// The rest of a torn report, if there is one: it goes before the next.
  std::optional<std::size_t> send_rest(std::span<std::uint8_t> buffer);
  /// Puts a report into the host's buffer, disturbed as `next` asks. Nothing if that drops it.
  std::optional<std::size_t> send(Bytes report, std::span<std::uint8_t> buffer, Disturbance& next);

 private:
  std::size_t turned_byte_;
  Bytes rest_;
};

}  // namespace kerf::emulators

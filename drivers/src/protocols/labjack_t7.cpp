#include "kerf/drivers/protocols/labjack_t7.h"

#include <cmath>

namespace kerf::drivers::labjack_t7 {
namespace {

constexpr std::size_t before_length_ends = 6;
constexpr std::size_t before_samples = 16;
constexpr std::uint8_t feedback = 76;

std::uint16_t word_in(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

}  // namespace

bool Calibration::is_plausible() const noexcept {
  constexpr Calibration nominal;
  constexpr double tolerance = 0.2;
  return std::abs(positive_slope / nominal.positive_slope - 1.0) < tolerance &&
         std::abs(negative_slope / nominal.negative_slope - 1.0) < tolerance &&
         std::abs(centre / nominal.centre - 1.0) < tolerance;
}

std::optional<std::size_t> Protocol::size_of(std::span<const std::uint8_t> bytes) noexcept {
  const std::size_t size = before_length_ends + word_in(bytes, 4);
  const bool is_stream = word_in(bytes, 2) == 0 && bytes[7] == feedback;
  if (!is_stream || size < before_samples || size > longest || size % 2 != 0) return std::nullopt;
  return size;
}

Packet parse(std::span<const std::uint8_t> packet) noexcept {
  return {.backlog_bytes = word_in(packet, 10),
          .status = word_in(packet, 12),
          .additional = word_in(packet, 14),
          .samples = packet.subspan(before_samples)};
}

}  // namespace kerf::drivers::labjack_t7

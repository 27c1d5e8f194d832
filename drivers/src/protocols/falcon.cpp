#include "kerf/drivers/protocols/falcon.h"

#include <cmath>

namespace kerf::drivers::falcon {
namespace {

constexpr std::uint8_t begin_mark = 0x3C;
constexpr std::uint8_t end_mark = 0x3E;
constexpr std::uint8_t zero = 0x41;
constexpr std::size_t bits_at = 13;
constexpr unsigned max_bits = 0x7F;

void put_number(Frame& frame, std::size_t at, int number) noexcept {
  const auto bits = static_cast<std::uint16_t>(number);
  for (std::size_t nibble = 0; nibble < 4; ++nibble) {
    frame[at + nibble] = static_cast<std::uint8_t>(zero + ((bits >> (4 * nibble)) & 0xFU));
  }
}
int number_at(const Frame& frame, std::size_t at) noexcept {
  unsigned bits = 0;
  for (std::size_t nibble = 0; nibble < 4; ++nibble) {
    bits |= static_cast<unsigned>(frame[at + nibble] - zero) << (4 * nibble);
  }
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

/// Whether a byte may stand at a place of a frame.
bool belongs(std::size_t place, std::uint8_t byte) noexcept {
  if (place == 0) return byte == begin_mark;
  if (place == frame_size - 1) return byte == end_mark;
  if (place == bits_at) return byte >= zero && byte <= zero + max_bits;
  if (place == bits_at + 1) return byte != begin_mark && byte != end_mark;  // its meaning is not known
  return byte >= zero && byte <= zero + 0xF;
}
bool is_frame(const Frame& frame) noexcept {
  for (std::size_t place = 0; place < frame_size; ++place) {
    if (!belongs(place, frame[place])) return false;
  }
  return true;
}

Frame with_numbers(const std::array<int, 3>& numbers, unsigned bits) noexcept {
  Frame frame;
  frame.front() = begin_mark;
  for (std::size_t i = 0; i < 3; ++i) put_number(frame, 1 + 4 * i, numbers[i]);
  frame[bits_at] = static_cast<std::uint8_t>(zero + bits);
  frame[bits_at + 1] = zero;
  frame.back() = end_mark;
  return frame;
}

}  // namespace

Frame encode(const Command& command) noexcept {
  std::array<int, 3> motor{};
  for (std::size_t i = 0; i < 3; ++i) motor[i] = std::clamp(command.motor[i], -max_motor, max_motor);
  const unsigned bits = (command.homing ? 1U : 0U) | (command.green ? 2U : 0U) | (command.blue ? 4U : 0U) |
                        (command.red ? 8U : 0U);
  return with_numbers(motor, bits);
}

Frame encode(const Report& report) noexcept {
  unsigned bits = (report.plus ? 1U : 0U) | (report.forward ? 2U : 0U) | (report.centre ? 4U : 0U) |
                  (report.minus ? 8U : 0U);
  for (std::size_t i = 0; i < 3; ++i) bits |= report.homed[i] ? 0x10U << i : 0U;
  return with_numbers(report.encoder, bits);
}

LettingGo letting_go(std::uint8_t endpoint, bool homing) noexcept {
  LettingGo transfers{.rounds = 2};
  transfers.send(endpoint, encode(Command{.homing = homing}));
  return transfers;
}

std::optional<Report> parse_report(const Frame& frame) noexcept {
  if (!is_frame(frame)) return std::nullopt;
  const unsigned bits = static_cast<unsigned>(frame[bits_at] - zero);
  return Report{.encoder = {number_at(frame, 1), number_at(frame, 5), number_at(frame, 9)},
                .homed = {(bits & 0x10U) != 0, (bits & 0x20U) != 0, (bits & 0x40U) != 0},
                .plus = (bits & 1U) != 0,
                .forward = (bits & 2U) != 0,
                .centre = (bits & 4U) != 0,
                .minus = (bits & 8U) != 0};
}

std::optional<Command> parse_command(const Frame& frame) noexcept {
  if (!is_frame(frame)) return std::nullopt;
  const unsigned bits = static_cast<unsigned>(frame[bits_at] - zero);
  return Command{.motor = {number_at(frame, 1), number_at(frame, 5), number_at(frame, 9)},
                 .homing = (bits & 1U) != 0,
                 .green = (bits & 2U) != 0,
                 .blue = (bits & 4U) != 0,
                 .red = (bits & 8U) != 0};
}

Motors motors_for(const std::array<double, 3>& torque_n_m, double units_per_n_m) noexcept {
  double largest = 0.0;
  for (const double torque : torque_n_m) {
    if (!std::isfinite(torque * units_per_n_m)) return {.value = {}, .limited = true};
    largest = std::max(largest, std::abs(torque * units_per_n_m));
  }
  Motors motors{.value = {}, .limited = largest > max_motor};
  const double scale = motors.limited ? max_motor / largest : 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    motors.value[i] = static_cast<int>(std::lround(-units_per_n_m * torque_n_m[i] * scale));
  }
  return motors;
}

std::optional<Frame> FrameReader::take(std::uint8_t byte) noexcept {
  if (!belongs(filled_, byte)) {
    dropped_ += filled_;
    filled_ = 0;
    if (byte != begin_mark) {
      ++dropped_;
      return std::nullopt;
    }
  }
  frame_[filled_++] = byte;
  if (filled_ < frame_size) return std::nullopt;
  filled_ = 0;
  return frame_;
}

}  // namespace kerf::drivers::falcon

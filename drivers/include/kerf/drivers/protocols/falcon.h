#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <kerf/drivers/protocols/letting_go.h>

/// The Novint Falcon on the wire: 16 bytes to it, 16 bytes back, behind an FTDI bridge. Pure functions.
///
/// A frame is '<', three 16-bit numbers, two bytes of bits, '>'. A number is four nibbles, least significant
/// first, each as 'A' + nibble. There is no checksum: what is out of place is dropped up to the next '<'.
///
/// Source: facts of the BSD part of libnifalcon (FalconFirmwareNovintSDK).
namespace kerf::drivers::falcon {

inline constexpr std::size_t frame_size = 16;
inline constexpr int max_motor = 4095;  ///< the SDK never exceeds it
using Frame = std::array<std::uint8_t, frame_size>;

/// What the host asks for. The homing bit must stand in every frame until the device is homed, and while it
/// is to be.
struct Command {
  std::array<int, 3> motor{};  ///< top, right, left; within +-4095
  bool homing = false;
  bool green = false;
  bool blue = false;
  bool red = false;
};

/// What the device answers.
struct Report {
  std::array<int, 3> encoder{};  ///< counts; relative to power-on until homed
  std::array<bool, 3> homed{};
  bool plus = false;  ///< the four buttons of the grip
  bool forward = false;
  bool centre = false;
  bool minus = false;

  friend bool operator==(const Report&, const Report&) = default;
};

/// Motor values are cut to +-4095 one by one; clamped() keeps the direction of the force instead.
[[nodiscard]] Frame encode(const Command& command) noexcept;
[[nodiscard]] Frame encode(const Report& report) noexcept;

/// All motors at zero, twice: the first may complete a frame that was torn. With `homing` it stays homed.
[[nodiscard]] LettingGo letting_go(std::uint8_t endpoint, bool homing) noexcept;

/// Nothing unless every byte is where it belongs.
[[nodiscard]] std::optional<Report> parse_report(const Frame& frame) noexcept;
[[nodiscard]] std::optional<Command> parse_command(const Frame& frame) noexcept;

/// Motor values for torques of the arms [N·m], V = -K tau, all three scaled alike if one exceeds 4095, so
/// that the force keeps its direction. Zero for a torque that is not finite. K is a calibration [units per
/// N·m]; it is not settled.
struct Motors {
  std::array<int, 3> value{};
  bool limited = false;
};
[[nodiscard]] Motors motors_for(const std::array<double, 3>& torque_n_m, double units_per_n_m) noexcept;

/// Finds frames in a stream of bytes, whole or in pieces, with bytes lost or added.
class FrameReader {
 public:
  /// Takes one byte; returns a frame when it completes one.
  std::optional<Frame> take(std::uint8_t byte) noexcept;
  /// Bytes that belonged to no frame.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  Frame frame_{};
  std::size_t filled_ = 0;
  std::uint64_t dropped_ = 0;
};

/// Calls `take(byte)` for every data byte of what a bulk transfer read: each packet of up to 64 bytes begins
/// with two bytes of modem and line status.
template <typename F>
void for_each_data_byte(std::span<const std::uint8_t> transfer, F&& take) {
  constexpr std::size_t packet = 64;
  constexpr std::size_t status = 2;
  for (std::size_t begin = 0; begin < transfer.size(); begin += packet) {
    const auto one = transfer.subspan(begin, std::min(packet, transfer.size() - begin));
    for (std::size_t i = status; i < one.size(); ++i) take(one[i]);
  }
}

}  // namespace kerf::drivers::falcon

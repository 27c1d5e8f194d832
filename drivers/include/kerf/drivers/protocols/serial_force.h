#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <kerf/drivers/force_health.h>

/// Force/torque sensors on serial lines: the frames that they stream. Pure functions; FrameReader finds the
/// frames. Sources: the makers' examples and drivers, and public clients of each.
namespace kerf::drivers {

/// Bota (SensONE, MegaONE, Rokubi): 37 bytes, little-endian:
///
///     AA, status u16, fx fy fz [N] tx ty tz [N·m] float32, time stamp u32 [us], temperature float32 [degC],
///     CRC-16/X.25 of bytes 1 to 34
namespace bota {

inline constexpr std::size_t head = 1;
inline constexpr std::size_t longest = 37;
inline constexpr double sinc_period_s = 19.53125e-6;  ///< times the length of the filter: a period

struct Frame {
  std::uint16_t status = 0;
  std::array<float, 6> wrench{};
  std::uint32_t stamp_us = 0;  ///< wraps
  float temperature = 0.0F;
};

struct Protocol {
  static constexpr std::size_t head = bota::head;
  static constexpr std::size_t longest = bota::longest;
  static std::optional<std::size_t> size_of(std::span<const std::uint8_t> head) noexcept;
  static bool is_sound(std::span<const std::uint8_t> frame) noexcept;
};
/// Of a frame that is sound. A number that is not finite stays so.
[[nodiscard]] Frame parse(std::span<const std::uint8_t> frame) noexcept;
[[nodiscard]] ForceHealth health_of(const Frame& frame) noexcept;
[[nodiscard]] std::string in_words(std::uint16_t status);
/// The code of a speed for the command `c`; nothing for one that it does not have.
[[nodiscard]] std::optional<int> baud_code(unsigned baud) noexcept;
/// The length of its sinc filter for a rate, 51 to 512; nothing for a rate out of reach.
[[nodiscard]] std::optional<int> sinc_length(double rate_hz) noexcept;

}  // namespace bota

/// OptoForce and OnRobot HEX, OMD by USB: big-endian, 16 bytes of three forces or 22 of a wrench:
///
///     AA 07 08 0A (three) or 10 (six), counter u16, status u16, counts i16 each, sum of all bytes before,
///     u16
namespace optoforce {

struct Frame {
  std::uint16_t counter = 0;
  std::uint16_t status = 0;
  std::size_t components = 0;  ///< 3 or 6
  std::array<std::int16_t, 6> counts{};
};

struct Protocol {
  static constexpr std::size_t head = 4;
  static constexpr std::size_t longest = 22;
  static std::optional<std::size_t> size_of(std::span<const std::uint8_t> head) noexcept;
  static bool is_sound(std::span<const std::uint8_t> frame) noexcept;
};
[[nodiscard]] Frame parse(std::span<const std::uint8_t> frame) noexcept;
[[nodiscard]] ForceHealth health_of(std::uint16_t status) noexcept;
[[nodiscard]] std::string in_words(std::uint16_t status);
/// Sets speed, filter and zero. @param speed 0 stop, else milliseconds: 1, 3, 10, 33, 100
[[nodiscard]] std::array<std::uint8_t, 9> configuration(std::uint8_t speed, std::uint8_t filter,
                                                        bool zero) noexcept;

}  // namespace optoforce

/// Robotiq FT300, while it streams: 16 bytes, little-endian, no count and no status:
///
///     20 4E, fx fy fz i16 [0.01 N], tx ty tz i16 [0.001 N·m], CRC-16/Modbus of bytes 0 to 13
namespace ft300 {

inline constexpr double rate_hz = 100.0;
inline constexpr int slave = 9;
inline constexpr int baud = 19200;
inline constexpr int stream_register = 410;
inline constexpr std::uint16_t stream_on = 0x0200;
inline constexpr std::size_t stream_off_bytes = 50;  ///< of FF

struct Protocol {
  static constexpr std::size_t head = 2;
  static constexpr std::size_t longest = 16;
  static std::optional<std::size_t> size_of(std::span<const std::uint8_t> head) noexcept;
  static bool is_sound(std::span<const std::uint8_t> frame) noexcept;
};
/// N and N·m.
[[nodiscard]] std::array<double, 6> parse(std::span<const std::uint8_t> frame) noexcept;

}  // namespace ft300

}  // namespace kerf::drivers

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

/// LabJack T7 without the maker's library: registers by Modbus TCP at port 502, and a stream of samples at
/// port 702. Pure functions. Numbers of 32 bits stand in two registers, the high word first.
///
/// A packet of the stream, big-endian, `length` counted from its seventh byte:
///
///     transaction u16, 0 u16, length u16, unit u8, 76 u8, type u16, backlog u16 [bytes], status u16,
///     additional u16, samples u16 each
///
/// Source: facts of the maker's data sheet and register table.
namespace kerf::drivers::labjack_t7 {

inline constexpr std::uint16_t command_port = 502;
inline constexpr std::uint16_t stream_port = 702;

// Registers.
inline constexpr int range = 40000;              ///< + 2 n: float, V
inline constexpr int negative_channel = 41000;   ///< + n: u16
inline constexpr int scan_rate = 4002;           ///< float, Hz; read back: the one it has
inline constexpr int address_count = 4004;       ///< u32
inline constexpr int samples_per_packet = 4006;  ///< u32
inline constexpr int target = 4016;              ///< u32; 1: port 702
inline constexpr int scans = 4020;               ///< u32; 0: without end
inline constexpr int scan_list = 4100;           ///< + 2 i: u32, addresses
inline constexpr int enable = 4990;              ///< u32
inline constexpr int test = 55100;               ///< u32
inline constexpr std::uint32_t test_value = 0x00112233;
inline constexpr int serial_number = 60028;  ///< u32
inline constexpr int firmware = 60004;       ///< float
inline constexpr int flash_pointer = 61810;  ///< u32
inline constexpr int flash_data = 61812;     ///< float each, from there on
inline constexpr std::uint32_t calibration_at = 0x003C4000;

/// Of the high-speed converter and the range of 10 V:
///
///     V = positive_slope (code - centre) above the centre, negative_slope (centre - code) below
struct Calibration {
  double positive_slope = 3.1580578e-4;
  double negative_slope = -3.1580580e-4;
  double centre = 33523.0;

  [[nodiscard]] double volts(std::uint16_t code) const noexcept {
    const double above = code - centre;
    return above < 0.0 ? -above * negative_slope : above * positive_slope;
  }
  /// Within a fifth of the nominal one.
  [[nodiscard]] bool is_plausible() const noexcept;
};

inline constexpr std::uint16_t recovering = 2940;  ///< its buffer was full; what was in it still comes
inline constexpr std::uint16_t recovered =
    2941;  ///< `additional`: scans that were left out before this packet

struct Packet {
  std::uint16_t backlog_bytes = 0;
  std::uint16_t status = 0;
  std::uint16_t additional = 0;
  std::span<const std::uint8_t> samples;  ///< big-endian, two bytes each

  [[nodiscard]] std::uint16_t sample(std::size_t i) const noexcept {
    return static_cast<std::uint16_t>(samples[2 * i] << 8 | samples[2 * i + 1]);
  }
};

/// Of FrameReader.
struct Protocol {
  static constexpr std::size_t head = 8;
  static constexpr std::size_t longest = 1040;
  static std::optional<std::size_t> size_of(std::span<const std::uint8_t> head) noexcept;
  /// TCP has sums of its own.
  static bool is_sound(std::span<const std::uint8_t>) noexcept { return true; }
};
[[nodiscard]] Packet parse(std::span<const std::uint8_t> packet) noexcept;

}  // namespace kerf::drivers::labjack_t7

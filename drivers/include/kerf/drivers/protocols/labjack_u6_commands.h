#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <kerf/drivers/protocols/labjack_u6.h>

/// The commands by which a LabJack U6 is set up before it streams, and their answers. Pure functions. Source:
/// as for labjack_u6.h.
namespace kerf::drivers::labjack_u6 {

inline constexpr std::uint16_t vendor = 0x0CD5;
inline constexpr std::uint16_t product = 0x0006;
inline constexpr std::uint8_t command_endpoint = 0x01;
inline constexpr std::uint8_t answer_endpoint = 0x82;
inline constexpr std::uint8_t stream_endpoint = 0x83;
inline constexpr std::uint8_t not_streaming = 52;  ///< what StreamStop answers where there is nothing to stop

/// What it calls itself.
struct Identification {
  std::uint32_t serial = 0;
  std::uint8_t firmware_major = 0;
  std::uint8_t firmware_minor = 0;
  std::uint8_t hardware_major = 0;
  std::uint8_t hardware_minor = 0;
  bool pro = false;
};
/// ConfigU6 that changes nothing and asks.
[[nodiscard]] Message identify() noexcept;
/// Nothing unless it is such an answer, without an error, of a U6.
[[nodiscard]] std::optional<Identification> parse_identification(
    std::span<const std::uint8_t> bytes) noexcept;

/// ReadCal: one block, 0 to 9, of four constants.
[[nodiscard]] Message read_constants(std::uint8_t block) noexcept;
[[nodiscard]] std::optional<std::array<double, 4>> parse_constants(
    std::span<const std::uint8_t> bytes) noexcept;

/// The calibration of +-10 V from blocks 0 and 2. Nothing if it is farther than 5 % from the nominal one: a
/// memory that was erased or never written.
[[nodiscard]] std::optional<Calibration> ten_volt_calibration(const std::array<double, 4>& block_0,
                                                              const std::array<double, 4>& block_2) noexcept;

/// ConfigIO: no timers and no counters.
[[nodiscard]] Message no_timers() noexcept;
[[nodiscard]] bool is_no_timers(std::span<const std::uint8_t> bytes) noexcept;

/// The error of an answer to StreamConfig; nothing if it is none.
[[nodiscard]] std::optional<std::uint8_t> parse_stream_config(std::span<const std::uint8_t> bytes) noexcept;

[[nodiscard]] Message stream_start() noexcept;
[[nodiscard]] Message stream_stop() noexcept;
/// The error of an answer to one of these; nothing if it is none.
[[nodiscard]] std::optional<std::uint8_t> parse_stream_start(std::span<const std::uint8_t> bytes) noexcept;
[[nodiscard]] std::optional<std::uint8_t> parse_stream_stop(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace kerf::drivers::labjack_u6

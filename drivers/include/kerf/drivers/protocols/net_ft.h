#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <kerf/drivers/force_health.h>

/// The raw data transfer (RDT) of ATI's Net F/T and of OnRobot's (OptoForce's) EtherDAQ: datagrams to and
/// from UDP port 49152, and the page in which ATI's box says its units. Pure functions.
///
/// A request has 8 bytes, a record 36, big-endian:
///
///     0x1234, command, count                  rdt_sequence, ft_sequence, status, fx fy fz tx ty tz [counts]
///     u16     u16      u32                    u32           u32          u32     i32
///
/// Source: public clients of both boxes, and the makers' manuals as they quote them.
namespace kerf::drivers::net_ft {

inline constexpr std::uint16_t port = 49152;
inline constexpr std::size_t request_size = 8;
inline constexpr std::size_t record_size = 36;

enum class Command : std::uint16_t {
  stop = 0x0000,
  start = 0x0002,   ///< one record a datagram; count: of records, 0: until stopped
  bias = 0x0042,    ///< ATI: count 0; OnRobot: 255 sets it, 0 takes it back
  filter = 0x0081,  ///< OnRobot: 0 none, 1 500, 2 150, 3 50, 4 15, 5 5, 6 1.5 Hz
  period = 0x0082,  ///< OnRobot: ms, 1 to 255
};

using Request = std::array<std::uint8_t, request_size>;
[[nodiscard]] Request request(Command command, std::uint32_t count) noexcept;

struct Record {
  std::uint32_t rdt_sequence = 0;  ///< of this read-out, from 1; wraps
  std::uint32_t ft_sequence = 0;   ///< of the box's own readings, which are more
  std::uint32_t status = 0;
  std::array<std::int32_t, 6> counts{};
};
/// Nothing for any other size.
[[nodiscard]] std::optional<Record> parse_record(std::span<const std::uint8_t> bytes) noexcept;

/// Whose status words and habits.
enum class Box : std::uint8_t { ati, onrobot };

/// What a status says of the wrench beside it. A latched threshold (0x80010000) is a matter of the box's own.
[[nodiscard]] ForceHealth health_of(Box box, std::uint32_t status) noexcept;
/// "transducer saturation or A/D, watchdog"; empty for none.
[[nodiscard]] std::string in_words(Box box, std::uint32_t status);

/// Corner of OnRobot's filter [Hz], 0: none; nothing for a number that it does not have.
[[nodiscard]] std::optional<double> onrobot_corner_hz(std::uint64_t filter) noexcept;

/// What ATI's box says of itself in `/netftapi2.xml`.
struct Page {
  std::string product;
  double counts_per_n = 0.0;
  double counts_per_n_m = 0.0;
  std::optional<double> rate_hz;      ///< comrdtrate
  std::optional<std::string> filter;  ///< setuserfilter: a number whose corner no public source tells
  std::optional<std::string> bias;    ///< setbias: six offsets of the gauges
  std::optional<std::string> tool;    ///< cfgtfx: how the box turns and moves the frame
  std::optional<std::string> serial;  ///< cfgcalsn: of the calibration, so of the transducer
  std::optional<bool> enabled;        ///< comrdte
};
/// What a unit that the box names is in N, or in N·m; nothing for one that is not known.
[[nodiscard]] std::optional<double> force_unit_n(std::string_view name) noexcept;
[[nodiscard]] std::optional<double> torque_unit_n_m(std::string_view name) noexcept;

/// Reads the page; the name of its root is the firmware's.
/// @throws std::invalid_argument with what is missing or not a number above zero.
[[nodiscard]] Page parse_page(std::string_view xml);

}  // namespace kerf::drivers::net_ft

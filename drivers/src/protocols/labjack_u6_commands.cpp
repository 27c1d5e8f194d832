#include "kerf/drivers/protocols/labjack_u6_commands.h"

#include <algorithm>
#include <cmath>

namespace kerf::drivers::labjack_u6 {
namespace {

constexpr std::uint8_t extended = 0xF8;
constexpr std::uint8_t config_io_command = 0x0B;
constexpr std::uint8_t config_u6_command = 0x08;
constexpr std::uint8_t read_constants_command = 0x2D;
constexpr std::uint8_t stream_config_command = 0x11;
constexpr std::uint8_t stream_start_command = 0xA8;
constexpr std::uint8_t stream_stop_command = 0xB0;
constexpr std::uint8_t u6 = 6;          // product id
constexpr std::uint8_t pro_bit = 0x08;  // of the version info

Message command(std::uint8_t number, std::size_t size, std::initializer_list<std::uint8_t> data) noexcept {
  Message message;
  message.size = size;
  message.bytes[1] = extended;
  message.bytes[2] = static_cast<std::uint8_t>((size - 6) / 2);
  message.bytes[3] = number;
  std::ranges::copy(data, message.bytes.begin() + 6);
  seal(std::span(message.bytes).first(size));
  return message;
}

bool is_answer(std::span<const std::uint8_t> bytes, std::uint8_t number, std::size_t size) noexcept {
  return bytes.size() == size && bytes[1] == extended && bytes[2] == (size - 6) / 2 && bytes[3] == number &&
         is_sealed(bytes);
}

Message plain(std::uint8_t number) noexcept {
  Message message;
  message.size = 2;
  message.bytes[0] = message.bytes[1] = number;  // the first is the checksum of the second
  return message;
}

std::optional<std::uint8_t> parse_plain(std::span<const std::uint8_t> bytes, std::uint8_t number) noexcept {
  if (bytes.size() != 4 || bytes[1] != number || bytes[0] != checksum8(bytes.subspan(1))) return std::nullopt;
  return bytes[2];
}

bool within_5_percent(double value, double nominal) noexcept {
  return std::abs(value - nominal) <= 0.05 * std::abs(nominal);
}

}  // namespace

Message identify() noexcept { return command(config_u6_command, 26, {}); }

std::optional<Identification> parse_identification(std::span<const std::uint8_t> bytes) noexcept {
  if (!is_answer(bytes, config_u6_command, 38) || bytes[6] != 0 || bytes[19] != u6) return std::nullopt;
  return Identification{.serial = bytes[15] | static_cast<std::uint32_t>(bytes[16]) << 8U |
                                  static_cast<std::uint32_t>(bytes[17]) << 16U |
                                  static_cast<std::uint32_t>(bytes[18]) << 24U,
                        .firmware_major = bytes[10],
                        .firmware_minor = bytes[9],
                        .hardware_major = bytes[14],
                        .hardware_minor = bytes[13],
                        .pro = (bytes[37] & pro_bit) != 0};
}

Message read_constants(std::uint8_t block) noexcept { return command(read_constants_command, 8, {0, block}); }

std::optional<std::array<double, 4>> parse_constants(std::span<const std::uint8_t> bytes) noexcept {
  if (!is_answer(bytes, read_constants_command, 40) || bytes[6] != 0) return std::nullopt;
  std::array<double, 4> constants{};
  for (std::size_t i = 0; i < constants.size(); ++i) {
    constants[i] = fixed_point(bytes.subspan(8 + 8 * i).first<8>());
  }
  return constants;
}

std::optional<Calibration> ten_volt_calibration(const std::array<double, 4>& block_0,
                                                const std::array<double, 4>& block_2) noexcept {
  const Calibration nominal;
  const Calibration found{.slope = block_0[0], .negative_slope = block_2[0], .centre = block_2[1]};
  const bool plausible = within_5_percent(found.slope, nominal.slope) &&
                         within_5_percent(found.negative_slope, nominal.negative_slope) &&
                         within_5_percent(found.centre, nominal.centre);
  return plausible ? std::optional(found) : std::nullopt;
}

Message no_timers() noexcept {
  return command(config_io_command, 16, {1});  // 1: write what follows
}

bool is_no_timers(std::span<const std::uint8_t> bytes) noexcept {
  return is_answer(bytes, config_io_command, 16) && bytes[6] == 0 && bytes[8] == 0 && bytes[9] == 0;
}

std::optional<std::uint8_t> parse_stream_config(std::span<const std::uint8_t> bytes) noexcept {
  if (!is_answer(bytes, stream_config_command, 8)) return std::nullopt;
  return bytes[6];
}

Message stream_start() noexcept { return plain(stream_start_command); }
Message stream_stop() noexcept { return plain(stream_stop_command); }

std::optional<std::uint8_t> parse_stream_start(std::span<const std::uint8_t> bytes) noexcept {
  return parse_plain(bytes, stream_start_command + 1);
}
std::optional<std::uint8_t> parse_stream_stop(std::span<const std::uint8_t> bytes) noexcept {
  return parse_plain(bytes, stream_stop_command + 1);
}

}  // namespace kerf::drivers::labjack_u6

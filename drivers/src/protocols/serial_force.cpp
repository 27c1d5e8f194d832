#include "kerf/drivers/protocols/serial_force.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <boost/crc.hpp>

namespace kerf::drivers {
namespace {

using X25 = boost::crc_optimal<16, 0x1021, 0xFFFF, 0xFFFF, true, true>;
using ModbusSum = boost::crc_optimal<16, 0x8005, 0xFFFF, 0, true, true>;

template <typename Sum>
std::uint16_t crc_of(std::span<const std::uint8_t> bytes) noexcept {
  Sum sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return sum.checksum();
}

std::uint16_t little16(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

std::uint32_t little32(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return std::uint32_t{little16(bytes, at)} | std::uint32_t{little16(bytes, at + 2)} << 16U;
}

std::uint16_t big16(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

std::uint16_t sum16(std::span<const std::uint8_t> bytes) noexcept {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint16_t>(sum);
}

}  // namespace

namespace bota {
namespace {

constexpr std::uint8_t mark = 0xAA;
constexpr std::uint16_t overrange = 1U << 1U;
constexpr std::uint16_t invalid = 1U << 2U;
constexpr std::uint16_t raw = 1U << 3U;

}  // namespace

std::optional<std::size_t> Protocol::size_of(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes[0] != mark) return std::nullopt;
  return bota::longest;
}

bool Protocol::is_sound(std::span<const std::uint8_t> frame) noexcept {
  return crc_of<X25>(frame.subspan(1, 34)) == little16(frame, 35);
}

Frame parse(std::span<const std::uint8_t> frame) noexcept {
  Frame parsed{.status = little16(frame, 1), .stamp_us = little32(frame, 27)};
  for (std::size_t i = 0; i < parsed.wrench.size(); ++i)
    parsed.wrench[i] = std::bit_cast<float>(little32(frame, 3 + 4 * i));
  parsed.temperature = std::bit_cast<float>(little32(frame, 31));
  return parsed;
}

ForceHealth health_of(const Frame& frame) noexcept {
  const bool finite = std::ranges::all_of(frame.wrench, [](float one) { return std::isfinite(one); });
  if ((frame.status & overrange) != 0) return ForceHealth::overload;
  return finite && (frame.status & (invalid | raw)) == 0 ? ForceHealth::sound : ForceHealth::doubted;
}

std::string in_words(std::uint16_t status) {
  std::string all;
  constexpr std::array<const char*, 4> words{"its processor is too slow", "out of its range",
                                             "saturation, a short or an open gauge",
                                             "raw values of the gauges"};
  for (std::size_t bit = 0; bit < words.size(); ++bit) {
    if ((status >> bit & 1U) != 0) all.append(all.empty() ? "" : ", ").append(words.at(bit));
  }
  return all;
}

std::optional<int> baud_code(unsigned baud) noexcept {
  constexpr std::array<unsigned, 5> bauds{9600, 57600, 115200, 230400, 460800};
  const auto* found = std::ranges::find(bauds, baud);
  if (found == bauds.end()) return std::nullopt;
  return static_cast<int>(found - bauds.begin());
}

std::optional<int> sinc_length(double rate_hz) noexcept {
  constexpr int shortest = 51;
  constexpr int longest_filter = 512;
  const double length = std::round(1.0 / (sinc_period_s * rate_hz));
  if (!(length >= shortest && length <= longest_filter)) return std::nullopt;
  return static_cast<int>(length);
}

}  // namespace bota

namespace optoforce {
namespace {

constexpr std::array<std::uint8_t, 3> data_mark{0xAA, 0x07, 0x08};
constexpr std::uint8_t three_forces = 0x0A;
constexpr std::uint8_t a_wrench = 0x10;
constexpr std::size_t before_counts = 8;
// Two documents of the maker number the components the other way round: any is an overload.
constexpr std::uint16_t overload_bits = 0x03F0;
constexpr std::uint16_t sensor_bits = 0x1C00;
constexpr std::uint16_t box_bits = 0xE000;

}  // namespace

std::optional<std::size_t> Protocol::size_of(std::span<const std::uint8_t> bytes) noexcept {
  if (!std::ranges::equal(bytes.first(3), data_mark)) return std::nullopt;
  if (bytes[3] != three_forces && bytes[3] != a_wrench) return std::nullopt;
  return std::size_t{6} + bytes[3];
}

bool Protocol::is_sound(std::span<const std::uint8_t> frame) noexcept {
  return sum16(frame.first(frame.size() - 2)) == big16(frame, frame.size() - 2);
}

Frame parse(std::span<const std::uint8_t> frame) noexcept {
  Frame parsed{.counter = big16(frame, 4),
               .status = big16(frame, 6),
               .components = frame[3] == a_wrench ? std::size_t{6} : std::size_t{3}};
  for (std::size_t i = 0; i < parsed.components; ++i)
    parsed.counts[i] = static_cast<std::int16_t>(big16(frame, before_counts + 2 * i));
  return parsed;
}

ForceHealth health_of(std::uint16_t status) noexcept {
  if ((status & overload_bits) != 0) return ForceHealth::overload;
  return (status & (sensor_bits | box_bits)) != 0 ? ForceHealth::doubted : ForceHealth::sound;
}

std::string in_words(std::uint16_t status) {
  std::string all;
  const auto add = [&](const char* words) { all.append(all.empty() ? "" : ", ").append(words); };
  if ((status & overload_bits) != 0) add("overload");
  const unsigned sensor = (status & sensor_bits) >> 10U;
  if (sensor == 1) add("no sensor");
  if (sensor > 1) add(sensor == 4 ? "temperature" : "sensor failure");
  const unsigned box = (status & box_bits) >> 13U;
  if (box == 1) add("converter");
  if (box > 1) add("communication");
  return all;
}

std::array<std::uint8_t, 9> configuration(std::uint8_t speed, std::uint8_t filter, bool zero) noexcept {
  std::array<std::uint8_t, 9> bytes{
      0xAA, 0x00, 0x32, 0x03, speed, filter, zero ? std::uint8_t{255} : std::uint8_t{0}};
  const std::uint16_t sum = sum16(std::span(bytes).first(7));
  bytes[7] = static_cast<std::uint8_t>(sum >> 8U);
  bytes[8] = static_cast<std::uint8_t>(sum);
  return bytes;
}

}  // namespace optoforce

namespace ft300 {

std::optional<std::size_t> Protocol::size_of(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes[0] != 0x20 || bytes[1] != 0x4E) return std::nullopt;
  return longest;
}

bool Protocol::is_sound(std::span<const std::uint8_t> frame) noexcept {
  return crc_of<ModbusSum>(frame.first(14)) == little16(frame, 14);
}

std::array<double, 6> parse(std::span<const std::uint8_t> frame) noexcept {
  std::array<double, 6> wrench{};
  for (std::size_t i = 0; i < wrench.size(); ++i) {
    const auto counts = static_cast<std::int16_t>(little16(frame, 2 + 2 * i));
    wrench[i] = counts * (i < 3 ? 0.01 : 0.001);
  }
  return wrench;
}

}  // namespace ft300

}  // namespace kerf::drivers

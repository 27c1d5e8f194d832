#include "kerf/drivers/protocols/labjack_u6.h"

#include <cmath>

namespace kerf::drivers::labjack_u6 {
namespace {

constexpr std::uint8_t extended = 0xF8;
constexpr std::uint8_t stream_data = 0xF9;
constexpr std::uint8_t stream_mark = 0xC0;
constexpr std::uint8_t stream_config_command = 0x11;
constexpr std::size_t samples_at = 12;
constexpr std::size_t around_samples = 14;  // bytes of a stream packet beside its samples
constexpr double clock_hz = 4e6;
constexpr double max_samples_per_s = 50e3;

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8U));
}
void put_word(std::span<std::uint8_t> bytes, std::size_t at, unsigned word) noexcept {
  bytes[at] = static_cast<std::uint8_t>(word & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>((word >> 8U) & 0xFFU);
}

}  // namespace

std::uint16_t checksum16(std::span<const std::uint8_t> bytes) noexcept {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint16_t>(sum);
}

std::uint8_t checksum8(std::span<const std::uint8_t> bytes) noexcept {
  unsigned sum = checksum16(bytes);
  sum = sum % 256 + sum / 256;
  return static_cast<std::uint8_t>(sum % 256 + sum / 256);
}

void seal(std::span<std::uint8_t> command) noexcept {
  put_word(command, 4, checksum16(command.subspan(6)));
  command[0] = checksum8(command.subspan(1, 5));
}

bool is_sealed(std::span<const std::uint8_t> packet) noexcept {
  return packet.size() >= 6 && word_at(packet, 4) == checksum16(packet.subspan(6)) &&
         packet[0] == checksum8(packet.subspan(1, 5));
}

std::optional<Message> stream_config(std::span<const Channel> channels, double rate_hz) noexcept {
  const std::size_t count = channels.size();
  const double interval = std::round(clock_hz / rate_hz);
  if (count < 1 || count > max_scan_channels || !(interval >= 1.0 && interval <= 65535.0) ||
      rate_hz * static_cast<double>(count) > max_samples_per_s) {
    return std::nullopt;
  }
  Message message;
  message.size = around_samples + 2 * count;
  auto bytes = std::span(message.bytes).first(message.size);
  bytes[1] = extended;
  bytes[2] = static_cast<std::uint8_t>(count + 4);
  bytes[3] = stream_config_command;
  bytes[6] = static_cast<std::uint8_t>(count);
  bytes[8] = static_cast<std::uint8_t>(count);  // samples a packet
  put_word(bytes, 12, static_cast<unsigned>(interval));
  for (std::size_t i = 0; i < count; ++i) {
    bytes[14 + 2 * i] = channels[i].number;
    bytes[15 + 2 * i] =
        static_cast<std::uint8_t>((channels[i].differential ? 0x80U : 0U) | ((channels[i].gain & 3U) << 4U));
  }
  seal(bytes);
  return message;
}

std::optional<StreamPacket> parse_stream(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() < around_samples + 2 || bytes.size() > max_packet || bytes[1] != stream_data ||
      bytes[3] != stream_mark || !is_sealed(bytes)) {
    return std::nullopt;
  }
  const std::size_t samples = (bytes.size() - around_samples) / 2;
  if (bytes.size() != around_samples + 2 * samples || bytes[2] != samples + 4) return std::nullopt;
  StreamPacket packet{.counter = bytes[10],
                      .error = bytes[11],
                      .time_stamp = word_at(bytes, 6) | static_cast<std::uint32_t>(word_at(bytes, 8)) << 16U,
                      .backlog = bytes[samples_at + 2 * samples],
                      .samples = samples};
  for (std::size_t i = 0; i < samples; ++i) packet.sample[i] = word_at(bytes, samples_at + 2 * i);
  return packet;
}

Message encode(const StreamPacket& packet) noexcept {
  Message message;
  message.size = around_samples + 2 * packet.samples;
  auto bytes = std::span(message.bytes).first(message.size);
  bytes[1] = stream_data;
  bytes[2] = static_cast<std::uint8_t>(packet.samples + 4);
  bytes[3] = stream_mark;
  put_word(bytes, 6, packet.time_stamp & 0xFFFFU);
  put_word(bytes, 8, packet.time_stamp >> 16U);
  bytes[10] = packet.counter;
  bytes[11] = packet.error;
  for (std::size_t i = 0; i < packet.samples; ++i) put_word(bytes, samples_at + 2 * i, packet.sample[i]);
  bytes[samples_at + 2 * packet.samples] = packet.backlog;
  seal(bytes);
  return message;
}

bool ScanAssembler::begin_packet(const StreamPacket& packet) noexcept {
  const auto missing = static_cast<std::uint8_t>(packet.counter - next_counter_);
  next_counter_ = static_cast<std::uint8_t>(packet.counter + 1);
  if (missing > 0) {
    next_sample_ += static_cast<std::uint64_t>(missing) * samples_per_packet_;
    whole_ = false;
  }
  if (packet.error == static_cast<std::uint8_t>(Error::recovery_overflow)) broken_ = true;
  if (broken_) return false;
  if (packet.error != static_cast<std::uint8_t>(Error::recovered)) return true;
  // The dummy scan and all that it stands for are gone; the next sample begins a scan.
  next_sample_ = (next_sample_ + channels_ - 1) / channels_ * channels_ +
                 static_cast<std::uint64_t>(packet.time_stamp) * channels_;
  whole_ = false;
  return false;
}

double fixed_point(std::span<const std::uint8_t, 8> bytes) noexcept {
  const auto word = [&](std::size_t at) {
    return word_at(bytes, at) | static_cast<std::uint32_t>(word_at(bytes, at + 2)) << 16U;
  };
  return static_cast<std::int32_t>(word(4)) + static_cast<double>(word(0)) / 4294967296.0;
}

}  // namespace kerf::drivers::labjack_u6

#include <algorithm>
#include <cmath>
#include <optional>

#include "devices/labjack_u6.h"

/// The commands of a LabJack U6 beside its stream.
namespace kerf::emulators {
namespace {

namespace wire = drivers::labjack_u6;

constexpr std::uint8_t extended = 0xF8;
constexpr std::uint8_t feedback_command = 0x00;
constexpr std::uint8_t config_u6_command = 0x08;
constexpr std::uint8_t timer_clock_command = 0x0A;
constexpr std::uint8_t config_io_command = 0x0B;
constexpr std::uint8_t stream_config_command = 0x11;
constexpr std::uint8_t constants_command = 0x2D;
constexpr std::uint8_t stream_start_command = 0xA8;
constexpr std::uint8_t stream_stop_command = 0xB0;
constexpr std::uint8_t write_local_id = 0x08;
constexpr std::uint8_t error_io_type = 112;  // assumed: the vendor's list was not at hand
constexpr std::uint8_t error_block = 26;     // assumed, the same
constexpr std::size_t feedback_header = 9;

Bytes bad_checksum() { return {0xB8, 0xB8}; }

/// Bytes of a whole IOType of Feedback, its number included; 0 if there is no such one.
std::size_t size_of_io(std::uint8_t type) {
  switch (type) {
    case 26:
    case 28:
      return 1;
    case 5:
    case 6:
    case 9:
    case 10:
    case 11:
    case 12:
    case 13:
    case 34:
    case 35:
    case 54:
    case 55:
      return 2;
    case 1:
    case 38:
    case 39:
      return 3;
    case 2:
    case 3:
      return 4;
    case 27:
    case 29:
      return 7;
    default:
      return type >= 42 && type <= 49 ? 4 : 0;
  }
}

void append24(Bytes& bytes, std::uint32_t number) {
  for (unsigned shift = 0; shift < 24; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

}  // namespace

Bytes EmulatedU6::answer(std::span<const std::uint8_t> command, std::int64_t now_ns) {
  if (command.size() >= 6 && command[1] == extended) {
    if (!wire::is_sealed(command) || command.size() != 6U + 2U * command[2]) return bad_checksum();
    Bytes reply = answer_extended(command, now_ns);
    if (reply.size() < 8) return reply;
    reply[1] = extended;
    reply[2] = static_cast<std::uint8_t>((reply.size() - 6) / 2);
    reply[3] = command[3];
    wire::seal(reply);
    return reply;
  }
  if (command.size() < 2 || command[0] != wire::checksum8(command.subspan(1))) return bad_checksum();
  Bytes reply{0, static_cast<std::uint8_t>(command[1] + 1), 0, 0};
  if (command[1] == stream_start_command) {
    reply[2] = start_stream(now_ns);
  } else if (command[1] == stream_stop_command) {
    reply[2] = stop_stream();
  } else {
    return bad_checksum();
  }
  reply[0] = wire::checksum8(std::span(reply).subspan(1));
  return reply;
}

Bytes EmulatedU6::answer_extended(std::span<const std::uint8_t> command, std::int64_t now_ns) {
  const auto sized = [&](std::size_t size) { return command.size() == size; };
  if (command[3] == config_u6_command && sized(26)) return config_u6(command);
  if (command[3] == config_io_command && sized(16)) return config_io(command);
  if (command[3] == timer_clock_command && sized(10)) return config_timer_clock(command);
  if (command[3] == constants_command && sized(8)) return read_constants(command);
  if (command[3] == stream_config_command && command.size() >= 16) return stream_config(command);
  if (command[3] == feedback_command && command.size() >= 8) return feedback(command, now_ns);
  return bad_checksum();
}

Bytes EmulatedU6::config_u6(std::span<const std::uint8_t> command) {
  if ((command[6] & write_local_id) != 0) local_id_ = command[8];
  Bytes reply(38, 0);
  reply[9] = 46;  // firmware 1.46
  reply[10] = 1;
  reply[11] = 15;  // boot loader 6.15
  reply[12] = 6;
  reply[14] = 2;  // hardware 2.00
  for (unsigned i = 0; i < 4; ++i) reply[15 + i] = static_cast<std::uint8_t>(options_.serial >> 8U * i);
  reply[19] = 6;  // product
  reply[21] = local_id_;
  reply[37] = 4;  // U6, not Pro
  return reply;
}

Bytes EmulatedU6::config_io(std::span<const std::uint8_t> command) {
  if ((command[6] & 1U) != 0) timers_ = {command[7], command[8]};
  Bytes reply(16, 0);
  reply[8] = timers_[0];
  reply[9] = timers_[1];
  reply[10] = command[9];
  return reply;
}

Bytes EmulatedU6::config_timer_clock(std::span<const std::uint8_t> command) {
  if ((command[8] & 0x80U) != 0) timer_clock_ = {static_cast<std::uint8_t>(command[8] & 0x7FU), command[9]};
  Bytes reply(10, 0);
  reply[8] = timer_clock_[0];
  reply[9] = timer_clock_[1];
  return reply;
}

Bytes EmulatedU6::read_constants(std::span<const std::uint8_t> command) const {
  Bytes reply(40, 0);
  if (command[7] > 9) {
    reply[6] = error_block;
    return reply;
  }
  const auto values = constants(command[7]);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto bits =
        static_cast<std::uint64_t>(std::llround(values[i] * 0x1p32));  // 32.32, two's complement
    for (unsigned byte = 0; byte < 8; ++byte)
      reply[8 + 8 * i + byte] = static_cast<std::uint8_t>(bits >> 8U * byte);
  }
  return reply;
}

Bytes EmulatedU6::feedback(std::span<const std::uint8_t> command, std::int64_t now_ns) {
  Bytes reply(feedback_header, 0);
  reply[8] = command[6];
  std::span<const std::uint8_t> rest = command.subspan(7);
  std::uint8_t frame = 0;
  // One zero at the end makes the length even.
  while (!rest.empty() && !(rest.size() == 1 && rest[0] == 0)) {
    ++frame;
    const std::size_t size = size_of_io(rest[0]);
    const Bytes before = reply;
    if (size == 0 || size > rest.size() || !feed_back(rest.first(size), reply, now_ns) ||
        reply.size() > wire::max_packet) {
      reply = before;
      reply[6] = error_io_type;
      reply[7] = frame;
      break;
    }
    rest = rest.subspan(size);
  }
  if (reply.size() % 2 != 0) reply.push_back(0);
  return reply;
}

bool EmulatedU6::feed_back(std::span<const std::uint8_t> io, Bytes& data, std::int64_t now_ns) {
  const std::uint8_t type = io[0];
  const auto bank = [&] {
    return std::min<std::size_t>(io[1] / 8U, 2);
  };  // IO number 0-7 FIO, 8-15 EIO, 16-19 CIO
  const auto set_bit = [&](std::uint32_t& bits) {
    const std::uint32_t bit = 1U << (io[1] & 7U);
    bits = (io[1] & 0x80U) != 0 ? bits | bit : bits & ~bit;
  };
  const auto write_ports = [&](std::array<std::uint32_t, 3>& ports) {
    for (std::size_t i = 0; i < 3; ++i)
      ports[i] = (ports[i] & ~static_cast<std::uint32_t>(io[1 + i])) | (io[4 + i] & io[1 + i]);
  };
  const auto read_ports = [&](const std::array<std::uint32_t, 3>& ports) {
    for (const std::uint32_t port : ports) data.push_back(static_cast<std::uint8_t>(port));
  };
  switch (type) {
    case 1: {  // AIN
      const double exact = code(volts(io[1], inputs(world_s(now_ns))), 0);
      const auto number = static_cast<std::uint16_t>(std::lround(std::clamp(exact, 0.0, 65535.0)));
      data.push_back(static_cast<std::uint8_t>(number));
      data.push_back(static_cast<std::uint8_t>(number >> 8U));
      return true;
    }
    case 2:    // AIN24
    case 3: {  // AIN24AR, which tells its range and a status
      const unsigned gain = type == 3 && io[2] >> 4U == 15U ? 0U : io[2] >> 4U;
      if (gain > 3) return false;
      const double exact = code(volts(io[1], inputs(world_s(now_ns))), gain);
      append24(data, static_cast<std::uint32_t>(std::lround(256.0 * std::clamp(exact, 0.0, 65535.0))));
      if (type == 3) data.insert(data.end(), {static_cast<std::uint8_t>((io[2] & 0x0FU) | gain << 4U), 0});
      return true;
    }
    case 9:
      led_ = io[1] != 0;
      return true;
    case 10:
      data.push_back(static_cast<std::uint8_t>(port_state_[bank()] >> (io[1] & 7U) & 1U));
      return true;
    case 11:
      set_bit(port_state_[std::min<std::size_t>((io[1] & 0x1FU) / 8U, 2)]);
      return true;
    case 12:
      data.push_back(static_cast<std::uint8_t>(port_direction_[bank()] >> (io[1] & 7U) & 1U));
      return true;
    case 13:
      set_bit(port_direction_[std::min<std::size_t>((io[1] & 0x1FU) / 8U, 2)]);
      return true;
    case 26:
      read_ports(port_state_);
      return true;
    case 27:
      write_ports(port_state_);
      return true;
    case 28:
      read_ports(port_direction_);
      return true;
    case 29:
      write_ports(port_direction_);
      return true;
    case 34:
    case 35:
      dac_[type - 34U] = static_cast<std::uint16_t>(io[1] << 8U);
      return true;
    case 38:
    case 39:
      dac_[type - 38U] = static_cast<std::uint16_t>(io[1] | io[2] << 8U);
      return true;
    default:
      // Waits take no time here; timers and counters, none of which is on, are at zero.
      if ((type >= 42 && type <= 48 && type % 2 == 0) || type == 54 || type == 55)
        data.insert(data.end(), 4, 0);
      return true;
  }
}

}  // namespace kerf::emulators

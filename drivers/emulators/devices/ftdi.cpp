#include "devices/ftdi.h"

#include <algorithm>
#include <array>

namespace kerf::emulators {
namespace {

constexpr std::size_t packet_size = 64;
constexpr std::size_t packet_data = packet_size - Ftdi::status_size;
constexpr std::array<std::uint8_t, Ftdi::status_size> idle{0x01, 0x60};

enum Request : std::uint8_t {
  reset = 0x00,
  modem_control = 0x01,
  flow_control = 0x02,
  baud_rate = 0x03,
  data_format = 0x04,
  modem_status = 0x05,
  set_event_character = 0x06,
  set_error_character = 0x07,
  set_latency = 0x09,
  get_latency = 0x0A,
  read_eeprom = 0x90
};

/// 3 MHz by an integer and a fraction of eighths; 0 and 1 are special.
double baud_of(std::uint16_t value, std::uint16_t index) noexcept {
  constexpr std::array<double, 8> fractions{0.0, 0.5, 0.25, 0.125, 0.375, 0.625, 0.75, 0.875};
  constexpr double clock_hz = 3e6;
  const unsigned whole = value & 0x3FFFU;
  const double fraction = fractions[(value >> 14U) | (index & 1U) << 2U];
  if (whole == 0) return clock_hz;
  if (whole == 1) return clock_hz / 1.5;
  return clock_hz / (whole + fraction);
}

std::size_t packets_for(std::size_t data) noexcept {
  return std::max<std::size_t>(1, (data + packet_data - 1) / packet_data);
}

/// How much data a transfer of so many bytes can carry.
std::size_t room_in(std::size_t size) noexcept {
  const std::size_t rest = size % packet_size;
  return size / packet_size * packet_data + (rest > Ftdi::status_size ? rest - Ftdi::status_size : 0);
}

}  // namespace

std::optional<Bytes> Ftdi::control(const Setup& setup, Event& event) {
  event = Event::none;
  switch (setup.request) {
    case reset:
      // 0 is all of it; of 1 and 2 nobody agrees which is which direction.
      purge();
      if (setup.value == 0) {
        latency_ns_ = 16'000'000;
        event = Event::reset;
      } else {
        event = Event::purged;
      }
      return Bytes{};
    case modem_control: {
      constexpr unsigned dtr_mask = 0x0100;
      if ((setup.value & dtr_mask) == 0) return Bytes{};
      const bool was = dtr_;
      dtr_ = (setup.value & 1U) != 0;
      if (dtr_ != was) event = dtr_ ? Event::dtr_rose : Event::dtr_fell;
      return Bytes{};
    }
    case baud_rate:
      baud_ = baud_of(setup.value, setup.index);
      event = Event::baud;
      return Bytes{};
    case set_latency:
      latency_ns_ = 1'000'000 * std::max<std::int64_t>(1, setup.value & 0xFFU);
      return Bytes{};
    case flow_control:
    case data_format:
    case set_event_character:
    case set_error_character:
      return Bytes{};
    case modem_status:
      return Bytes(idle.begin(), idle.end());
    case get_latency:
      return Bytes{static_cast<std::uint8_t>(latency_ns_ / 1'000'000)};
    case read_eeprom:
      return Bytes{0xFF, 0xFF};
    default:
      return std::nullopt;
  }
}

void Ftdi::purge() noexcept {
  lost_ += line_.size();
  line_.clear();
}

void Ftdi::put(std::span<const std::uint8_t> bytes, std::int64_t ready_ns) {
  const std::int64_t earliest = line_.empty() ? ready_ns : std::max(ready_ns, line_.back().ready_ns);
  for (const std::uint8_t byte : bytes) line_.push_back({earliest, byte});
}

std::size_t Ftdi::waiting(std::int64_t now_ns) const noexcept {
  const auto later = std::ranges::find_if(line_, [&](const Arrival& one) { return one.ready_ns > now_ns; });
  return static_cast<std::size_t>(later - line_.begin());
}

std::size_t Ftdi::fill(std::span<std::uint8_t> buffer, std::size_t data) {
  std::size_t at = 0;
  for (std::size_t packet = 0; packet < packets_for(data); ++packet) {
    for (const std::uint8_t status : idle) {
      if (at < buffer.size()) buffer[at++] = status;
    }
    const std::size_t here = std::min(packet_data, data - packet * packet_data);
    for (std::size_t i = 0; i < here; ++i) {
      buffer[at++] = line_.front().byte;
      line_.pop_front();
    }
  }
  return at;
}

std::optional<std::size_t> Ftdi::send(std::span<std::uint8_t> buffer, std::int64_t waits_since_ns,
                                      std::int64_t now_ns, Disturbance& next) {
  // The timer of a real bridge does not wait for this program to be woken.
  const bool follows = waits_since_ns == answered_ns_ && answered_ns_ - meant_ns_ < latency_ns_;
  const std::int64_t expires_ns = (follows ? meant_ns_ : waits_since_ns) + latency_ns_;
  const std::size_t there = waiting(now_ns);
  if (there < packet_data && now_ns < expires_ns) {
    due_ns_ = expires_ns;
    if (line_.size() >= packet_data) due_ns_ = std::min(expires_ns, line_[packet_data - 1].ready_ns);
    return std::nullopt;
  }
  due_ns_.reset();
  answered_ns_ = now_ns;
  meant_ns_ = there < packet_data ? expires_ns : now_ns;
  std::size_t data = std::min(there, room_in(buffer.size()));
  if (data > 0) {
    switch (next) {
      case Disturbance::drop:
        line_.erase(line_.begin(), line_.begin() + static_cast<std::ptrdiff_t>(data));
        lost_ += data;
        data = 0;
        break;
      case Disturbance::split:
        data = (data + 1) / 2;  // the rest goes with the next packet
        break;
      case Disturbance::corrupt:
        line_.erase(line_.begin() + static_cast<std::ptrdiff_t>(data / 2));
        ++lost_;
        --data;
        break;
      case Disturbance::none:
        break;
    }
    next = Disturbance::none;
  }
  return fill(buffer, data);
}

}  // namespace kerf::emulators

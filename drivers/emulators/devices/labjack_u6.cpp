#include "devices/labjack_u6.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include <kerf/drivers/device.h>

#include "example_transducer.h"
#include "trace.h"

namespace kerf::emulators {
namespace {

namespace wire = drivers::labjack_u6;
using drivers::Axes;

constexpr std::size_t buffer_samples = 984;
constexpr std::uint16_t dummy_sample = 0xFFFF;
constexpr std::int64_t blocked_ns = 190'000'000;
constexpr std::uint8_t max_clock_bits = 0x0A;  // 48 MHz, and its division by 256
constexpr double slowest_clock_hz = 4e6;
constexpr double fastest_clock_hz = 48e6;
constexpr double max_samples_per_s = 50e3;

constexpr std::uint8_t error_active = 48;
constexpr std::uint8_t error_table = 49;
constexpr std::uint8_t error_config = 50;
constexpr std::uint8_t error_not_running = 52;
constexpr std::uint8_t error_overlap = 55;
constexpr std::uint8_t error_rate = 58;

constexpr std::uint8_t temperature_channel = 14;
constexpr double room_k = 295.15;

const Description& labjack() {
  static const Description description{
      .speed = Description::Speed::full,
      .device = {0x12, 0x01, 0x00, 0x02, 0xFF, 0xFF, 0xFF, 0x40, 0xD5, 0x0C, 0x06, 0x00, 0x00, 0x00, 0x01,
                 0x02, 0x00, 0x01},
      .configuration = {0x09, 0x02, 0x27, 0x00, 0x01, 0x01, 0x00, 0x80, 0xFA, 0x09, 0x04, 0x00, 0x00,
                        0x03, 0xFF, 0xFF, 0xFF, 0x00, 0x07, 0x05, 0x01, 0x02, 0x40, 0x00, 0x00, 0x07,
                        0x05, 0x82, 0x02, 0x40, 0x00, 0x00, 0x07, 0x05, 0x83, 0x02, 0x40, 0x00, 0x00},
      .strings = {"LabJack", "U6"},
      .reports = {}};
  return description;
}

/// To what 32 bits behind the point hold.
double as_stored(double value) { return std::round(value * 0x1p32) * 0x1p-32; }

double number_from(std::span<const std::uint8_t> bytes) { return bytes[0] | bytes[1] << 8; }

}  // namespace

const drivers::ForceCalibration& example_transducer() {
  static const drivers::ForceCalibration transducer =
      drivers::parse_force_calibration(example_transducer_toml, "examples/u6.calibration.toml");
  return transducer;
}

EmulatedU6::Options EmulatedU6::parse_options(drivers::Uri uri) {
  drivers::UriOptions given(std::move(uri));
  Options options;
  options.wrench.force_n = given.number("force", {"N", options.wrench.force_n, 0.0, 1e6});
  options.wrench.torque_n_m = given.number("torque", {"Nm", options.wrench.torque_n_m, 0.0, 1e6});
  options.drift_ppm = given.number("drift", {"ppm", options.drift_ppm, -1000.0, 1000.0});
  options.noise_codes = given.number("noise", {"1", options.noise_codes, 0.0, 1000.0});
  options.trim_ppm = given.number("trim", {"ppm", options.trim_ppm, -40e3, 40e3});
  options.serial = static_cast<std::uint32_t>(given.count("serial", options.serial));
  options.overflow_s = given.number("overflow", {"s", options.overflow_s, 0.0, 1e9});
  options.trace = given.text("trace").value_or("");
  if (const auto file = given.text("calibration"))
    options.transducer = drivers::read_force_calibration(*file);
  given.refuse_others();
  return options;
}

EmulatedU6::EmulatedU6(const Options& options)
    : options_(options),
      to_volts_(options.transducer.matrix.inverse()),
      trace_(open_trace(options.trace, "scan,t_device_s,t_host_s,fx,fy,fz,tx,ty,tz")) {}

const Description& EmulatedU6::description() const { return labjack(); }

std::optional<Bytes> EmulatedU6::control(const Setup&, std::span<const std::uint8_t>, std::int64_t) {
  return std::nullopt;  // it has no requests of its own
}

void EmulatedU6::receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
  if (endpoint != 1 || bytes.empty()) return;
  run_until(now_ns);
  ++commands_;
  answers_.push_back(answer(bytes, now_ns));
}

Axes EmulatedU6::wrench(double time_s) const noexcept { return options_.wrench.at(time_s); }

std::array<double, 4> EmulatedU6::constants(std::uint8_t block) const noexcept {
  const wire::Calibration nominal;
  const double trim = 1.0 + 1e-6 * options_.trim_ppm;
  const auto scaled = [&](double value) { return as_stored(trim * value); };
  switch (block > 5 ? block - 6 : block) {
    case 0:
      return {scaled(nominal.slope), 0.0, scaled(nominal.slope / 10.0), 0.0};
    case 1:
      return {scaled(nominal.slope / 100.0), 0.0, scaled(nominal.slope / 1000.0), 0.0};
    case 2:
      return {scaled(nominal.negative_slope), scaled(nominal.centre), scaled(nominal.negative_slope / 10.0),
              scaled(nominal.centre)};
    case 3:
      return {scaled(nominal.negative_slope / 100.0), scaled(nominal.centre),
              scaled(nominal.negative_slope / 1000.0), scaled(nominal.centre)};
    case 4:
      return {13200.0, 0.0, 13200.0, 0.0};
    default:
      return {as_stored(1e-5), as_stored(2e-4), as_stored(-92.379), as_stored(465.129)};
  }
}

Axes EmulatedU6::inputs(double time_s) const noexcept {
  const Axes acting = wrench(time_s);
  const Eigen::Matrix<double, 6, 1> signal =
      to_volts_ * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(acting.data()) + options_.transducer.bias_v;
  Axes inputs{};
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] = signal[static_cast<Eigen::Index>(i)];
  return inputs;
}

double EmulatedU6::volts(std::uint8_t channel, const Axes& inputs) noexcept {
  if (channel == temperature_channel) return (room_k - 465.129) / -92.379;
  // The transducer's negative wires lie on ground, so an even channel is the same by itself and as a pair.
  if (channel >= 12 || channel % 2 != 0) return 0.0;
  return inputs[channel / 2U];
}

double EmulatedU6::code(double volts, unsigned gain) const noexcept {
  const auto positive = constants(gain < 2 ? 0 : 1);
  const auto negative = constants(gain < 2 ? 2 : 3);
  const std::size_t at = std::size_t{2} * (gain % 2U);
  return negative[at + 1] + (volts < 0.0 ? -volts / negative[at] : volts / positive[at]);
}

std::uint16_t EmulatedU6::sample(const StreamChannel& channel, const Axes& inputs) noexcept {
  const double exact = code(volts(channel.number, inputs), channel.options >> 4U & 3U);
  const double noisy = exact + (options_.noise_codes > 0.0 ? options_.noise_codes * noise_() : 0.0);
  return static_cast<std::uint16_t>(std::lround(std::clamp(noisy, 0.0, 65535.0)));
}

double EmulatedU6::world_s(std::int64_t now_ns) const noexcept {
  return world_start_ns_ < 0 ? 0.0 : 1e-9 * static_cast<double>(now_ns - world_start_ns_);
}

Bytes EmulatedU6::stream_config(std::span<const std::uint8_t> command) {
  Bytes reply(8, 0);
  const std::size_t count = command[6];
  const std::size_t per_packet = command[8];
  const bool fast = (command[11] & 0x08U) != 0;
  const double divisor = (command[11] & 0x02U) != 0 ? 256.0 : 1.0;
  const double interval = number_from(command.subspan(12));
  const double rate_hz = (fast ? fastest_clock_hz : slowest_clock_hz) / divisor / interval;
  if (streaming_) {
    reply[6] = error_active;
  } else if (count < 1 || count > wire::max_scan_channels || command.size() != 14 + 2 * count) {
    reply[6] = error_table;
  } else if (per_packet < 1 || per_packet > wire::max_samples || (command[11] & ~max_clock_bits) != 0 ||
             command[7] > 8) {
    reply[6] = error_config;
  } else if (interval < 1.0) {
    reply[6] = error_rate;
  } else if (rate_hz * static_cast<double>(count) > max_samples_per_s) {
    reply[6] = error_overlap;
  }
  if (reply[6] != 0) return reply;
  channels_.clear();
  for (std::size_t i = 0; i < count; ++i) channels_.push_back({command[14 + 2 * i], command[15 + 2 * i]});
  samples_per_packet_ = per_packet;
  interval_ns_ = 1e9 / rate_hz;
  return reply;
}

std::uint8_t EmulatedU6::start_stream(std::int64_t now_ns) {
  if (streaming_) return error_active;
  if (channels_.empty()) return error_config;
  streaming_ = true;
  stream_start_ns_ = now_ns;
  if (world_start_ns_ < 0) {
    world_start_ns_ = now_ns;
    if (options_.overflow_s > 0.0) blocked_from_ns_ = now_ns + std::llround(1e9 * options_.overflow_s);
  }
  next_scan_ = 0;
  counter_ = 0;
  fifo_.clear();
  rest_of_split_.clear();
  recovering_ = false;
  dummy_stands_for_ = 0;
  return 0;
}

std::uint8_t EmulatedU6::stop_stream() {
  if (!streaming_) return error_not_running;
  streaming_ = false;
  return 0;
}

std::int64_t EmulatedU6::scan_ns(std::uint64_t scan) const noexcept {
  const double interval_ns = interval_ns_ * (1.0 + 1e-6 * options_.drift_ppm);
  return stream_start_ns_ + std::llround(static_cast<double>(scan + 1) * interval_ns);
}

std::uint64_t EmulatedU6::scans_due(std::int64_t now_ns) const noexcept {
  const double interval_ns = interval_ns_ * (1.0 + 1e-6 * options_.drift_ppm);
  auto due =
      static_cast<std::uint64_t>(std::max(0.0, static_cast<double>(now_ns - stream_start_ns_) / interval_ns));
  // The division may be off by one where the product is not.
  while (due > 0 && scan_ns(due - 1) > now_ns) --due;
  while (scan_ns(due) <= now_ns) ++due;
  return due;
}

void EmulatedU6::run_until(std::int64_t now_ns) {
  if (!streaming_) return;
  const std::uint64_t due = scans_due(now_ns);
  while (next_scan_ < due) {
    if (recovering_) {
      next_scan_ = due;
    } else if (fifo_.size() + channels_.size() > buffer_samples) {
      recovering_ = true;
      missing_from_ = next_scan_;
    } else {
      take_scan(next_scan_++);
    }
  }
}

void EmulatedU6::take_scan(std::uint64_t scan) {
  const std::int64_t taken_ns = scan_ns(scan);
  const double time_s = world_s(taken_ns);
  const Axes signals = inputs(time_s);
  for (const StreamChannel& channel : channels_) fifo_.push_back(sample(channel, signals));
  if (!trace_.is_open()) return;
  trace_ << fmt::format("{},{},{},{}\n", scan, 1e-9 * interval_ns_ * static_cast<double>(scan + 1),
                        1e-9 * static_cast<double>(taken_ns), [&] {
                          std::string text;
                          for (const double one : wrench(time_s))
                            text += fmt::format("{}{}", text.empty() ? "" : ",", one);
                          return text;
                        }());
}

void EmulatedU6::end_recovery() {
  if (!recovering_ || fifo_.size() >= samples_per_packet_) return;
  dummy_after_ = fifo_.size();
  dummy_stands_for_ = static_cast<std::uint32_t>(next_scan_ - missing_from_);
  fifo_.insert(fifo_.end(), channels_.size(), dummy_sample);
  scans_lost_ += dummy_stands_for_;
  recovering_ = false;
}

bool EmulatedU6::is_blocked(std::int64_t now_ns) const noexcept {
  return blocked_from_ns_ >= 0 && now_ns >= blocked_from_ns_ && now_ns < blocked_from_ns_ + blocked_ns;
}

bool EmulatedU6::has_packet() const noexcept { return fifo_.size() >= samples_per_packet_; }

wire::Message EmulatedU6::next_packet() {
  wire::StreamPacket packet{.counter = counter_++, .samples = samples_per_packet_};
  if (dummy_stands_for_ > 0 && dummy_after_ < samples_per_packet_) {
    packet.error = static_cast<std::uint8_t>(wire::Error::recovered);
    packet.time_stamp = std::exchange(dummy_stands_for_, 0);
  } else if (recovering_) {
    packet.error = static_cast<std::uint8_t>(wire::Error::recovering);
  }
  dummy_after_ -= std::min(dummy_after_, samples_per_packet_);
  for (std::size_t i = 0; i < samples_per_packet_; ++i) {
    packet.sample[i] = fifo_.front();
    fifo_.pop_front();
  }
  packet.backlog = static_cast<std::uint8_t>(std::min<std::size_t>(255, 256 * fifo_.size() / buffer_samples));
  ++packets_;
  return wire::encode(packet);
}

std::optional<std::size_t> EmulatedU6::send_stream(std::span<std::uint8_t> buffer, std::int64_t now_ns,
                                                   Disturbance& next) {
  run_until(now_ns);
  if (!rest_of_split_.empty()) {
    const std::size_t size = std::min(rest_of_split_.size(), buffer.size());
    std::copy_n(rest_of_split_.begin(), size, buffer.begin());
    rest_of_split_.clear();
    return size;
  }
  if (!streaming_ || is_blocked(now_ns)) return std::nullopt;
  end_recovery();
  if (next == Disturbance::drop && has_packet()) {
    (void)next_packet();
    next = Disturbance::none;
    end_recovery();
  }
  // Packets of 64 bytes do not end a transfer: a full one fills it. Shorter ones end it each.
  const bool fills = samples_per_packet_ == wire::max_samples;
  const std::size_t wanted = fills ? std::max<std::size_t>(1, buffer.size() / wire::max_packet) : 1;
  if (fifo_.size() < wanted * samples_per_packet_) return std::nullopt;
  std::size_t filled = 0;
  for (std::size_t i = 0; i < wanted; ++i) {
    auto packet = next_packet();
    end_recovery();
    if (next == Disturbance::corrupt) packet.bytes[packet.size / 2] ^= 0x10U;
    const std::size_t room = std::min(packet.size, buffer.size() - filled);
    const std::size_t size = next == Disturbance::split ? room / 2 : room;
    std::copy_n(packet.bytes.begin(), size, buffer.begin() + static_cast<std::ptrdiff_t>(filled));
    filled += size;
    if (std::exchange(next, Disturbance::none) == Disturbance::split) {
      rest_of_split_.assign(packet.bytes.begin() + static_cast<std::ptrdiff_t>(size),
                            packet.bytes.begin() + static_cast<std::ptrdiff_t>(packet.size));
      break;
    }
  }
  return filled;
}

std::optional<std::size_t> EmulatedU6::send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                            std::int64_t, std::int64_t now_ns, Disturbance& next) {
  if (endpoint == 3) return send_stream(buffer, now_ns, next);
  if (endpoint != 2 || answers_.empty()) return std::nullopt;
  const Bytes answer = std::move(answers_.front());
  answers_.pop_front();
  const std::size_t size = std::min(answer.size(), buffer.size());
  std::copy_n(answer.begin(), size, buffer.begin());
  return size;
}

std::optional<std::int64_t> EmulatedU6::next_event_ns(std::int64_t now_ns) const {
  if (!streaming_) return std::nullopt;
  if (is_blocked(now_ns)) return blocked_from_ns_ + blocked_ns;
  if (recovering_ || has_packet()) return now_ns;
  const std::size_t missing = samples_per_packet_ - fifo_.size();
  return scan_ns(next_scan_ + (missing + channels_.size() - 1) / channels_.size() - 1);
}

std::string EmulatedU6::tell() const {
  return fmt::format("{} commands, {} packets of {} samples, {} scans without room, LED {}", commands_,
                     packets_, samples_per_packet_, scans_lost_, led_ ? "on" : "off");
}

}  // namespace kerf::emulators

#include "serial/serial_sensor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <time.h>

#include <kerf/drivers/usb/io_thread.h>

namespace kerf::emulators {
namespace {

using drivers::usb::now_ns;

constexpr std::int64_t end_of_burst_ns = 3'000'000;
constexpr std::int64_t between_looks_ns = 1'000'000;
constexpr double torque_share = 0.05;

}  // namespace

EmulatedSerialSensor::Options EmulatedSerialSensor::parse_common(drivers::UriOptions& given) {
  Options options;
  options.link = given.text("link").value_or("");
  options.wrench.force_n = given.number("force", {"N", options.wrench.force_n, 0.0, 1e4});
  options.wrench.torque_n_m = given.number("torque", {"Nm", options.wrench.torque_n_m, 0.0, 1e3});
  options.noise_n = given.number("noise", {"N", 0.0, 0.0, 1e3});
  options.drift_ppm = given.number("drift", {"ppm", 0.0, -3e4, 3e4});
  options.loss = given.number("loss", {"1", 0.0, 0.0, 1.0});
  options.seed = given.count("seed", 1);
  options.trace = given.text("trace").value_or("");
  return options;
}

EmulatedSerialSensor::EmulatedSerialSensor(const Options& options, std::vector<Fault> faults, double baud)
    : options_(options),
      faults_(std::move(faults)),
      port_(options.link),
      line_(baud),
      noise_(options.seed),
      losses_(options.seed),
      began_ns_(now_ns()) {
  if (options_.trace.empty()) return;
  trace_.open(options_.trace);
  trace_ << "number,host_ns,fx,fy,fz,tx,ty,tz,left\n";
}

double EmulatedSerialSensor::world_s(std::int64_t at_ns) const noexcept {
  return world_start_ns_ ? 1e-9 * static_cast<double>(at_ns - *world_start_ns_) : 0.0;
}

std::int64_t EmulatedSerialSensor::frame_ns(std::uint64_t frame) const noexcept {
  const double period_ns = 1e9 / rate_hz_ * (1.0 + 1e-6 * options_.drift_ppm);
  return stream_start_ns_ + std::llround(period_ns * static_cast<double>(frame));
}

void EmulatedSerialSensor::stream(double rate_hz) {
  rate_hz_ = rate_hz;
  stream_start_ns_ = now_ns();
  measured_of_stream_ = 0;
}

void EmulatedSerialSensor::say(const Bytes& bytes) { line_.say(bytes, now_ns()); }

void EmulatedSerialSensor::say(const std::string& text) { say(Bytes(text.begin(), text.end())); }

void EmulatedSerialSensor::run(const std::atomic<bool>& stop, double seconds) {
  const auto unplugged_at_s = faults_.unplugged_at_s();
  while (!stop.load()) {
    const std::int64_t now = now_ns();
    if (seconds > 0.0 && 1e-9 * static_cast<double>(now - began_ns_) >= seconds) return;
    if (unplugged_at_s && world_start_ns_ && world_s(now) >= *unplugged_at_s) {
      port_.pull_out();
      return;
    }
    set_power(!world_start_ns_ || !faults_.is_without_power(world_s(now)), now);
    const bool is_open = port_.is_open();
    if (is_open && !was_open_) {
      if (!world_start_ns_) world_start_ns_ = powered_ns_ = now;
      opened();
    }
    was_open_ = is_open;
    if (has_power_) listen(now);  // a host may have closed since it wrote
    if (has_power_) send_due(now);
    line_.send_due(port_, now);
    std::int64_t next = std::min(now + between_looks_ns, line_.next_ns(now + between_looks_ns));
    if (streams()) next = std::min(next, frame_ns(measured_of_stream_ + 1));
    const timespec wait{.tv_sec = 0, .tv_nsec = std::max<std::int64_t>(0, next - now_ns())};
    nanosleep(&wait, nullptr);
  }
}

void EmulatedSerialSensor::set_power(bool on, std::int64_t at_ns) {
  if (on == has_power_) return;
  has_power_ = on;
  line_.clear();
  if (!on) {
    stop_stream();
    return;
  }
  powered_ns_ = at_ns;
  number_ = 0;
  begin_anew();
}

void EmulatedSerialSensor::listen(std::int64_t at_ns) {
  Bytes bytes(512);
  const std::ptrdiff_t size = port_.receive(bytes);
  if (size > 0) {
    hear(std::span(bytes).first(static_cast<std::size_t>(size)));
    heard_ns_ = at_ns;
  } else if (heard_ns_ && at_ns - *heard_ns_ > end_of_burst_ns) {
    heard_ns_.reset();
    heard_all();
  }
}

void EmulatedSerialSensor::send_due(std::int64_t at_ns) {
  while (streams() && frame_ns(measured_of_stream_ + 1) <= at_ns) measure(frame_ns(++measured_of_stream_));
}

EmulatedSerialSensor::Measured EmulatedSerialSensor::measured_at(std::int64_t taken_ns) {
  Measured measured{.time_s = world_s(taken_ns),
                    .powered_s = 1e-9 * static_cast<double>(taken_ns - powered_ns_),
                    .number = ++number_,
                    .wrench = options_.wrench.at(world_s(taken_ns)),
                    .overloaded = faults_.is_overloaded(world_s(taken_ns))};
  for (std::size_t i = 0; i < measured.wrench.size(); ++i)
    measured.wrench[i] += options_.noise_n * (i < 3 ? 1.0 : torque_share) * noise_();
  return measured;
}

/// The truth, without its noise.
void EmulatedSerialSensor::note(const Measured& measured, std::int64_t taken_ns, bool leaves) {
  if (!trace_.is_open()) return;
  trace_ << fmt::format("{},{},{},{}\n", measured.number, taken_ns,
                        fmt::join(options_.wrench.at(measured.time_s), ","), leaves ? 1 : 0);
}

EmulatedSerialSensor::Measured EmulatedSerialSensor::read_out() {
  const std::int64_t taken_ns = now_ns();
  const Measured measured = measured_at(taken_ns);
  note(measured, taken_ns, true);
  return measured;
}

void EmulatedSerialSensor::measure(std::int64_t taken_ns) {
  const Measured measured = measured_at(taken_ns);
  Bytes bytes = frame(measured);
  const bool drawn = static_cast<double>(losses_() >> 11U) * 0x1p-53 < options_.loss;
  const bool dropped = faults_.due(measured.time_s) == Disturbance::drop;
  if (dropped) faults_.done(Disturbance::drop, measured.time_s);
  const bool leaves = !drawn && !dropped && !faults_.is_silent(measured.time_s);
  note(measured, taken_ns, leaves);
  ++(leaves ? sent_ : left_out_);
  if (!leaves) return;
  if (faults_.due(measured.time_s) == Disturbance::corrupt) {
    faults_.done(Disturbance::corrupt, measured.time_s);
    bytes[bytes.size() / 2] ^= 0x10U;
  }
  say(bytes);
  if (faults_.duplicates(measured.time_s)) say(bytes);
}

std::string EmulatedSerialSensor::tell() const {
  return fmt::format("{} frames sent, {} left out", sent_, left_out_);
}

}  // namespace kerf::emulators

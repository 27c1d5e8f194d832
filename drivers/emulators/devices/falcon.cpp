#include "devices/falcon.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <kerf/drivers/device.h>
#include <kerf/mechanisms/falcon.h>

#include "trace.h"

namespace kerf::emulators {
namespace {

using mechanisms::Falcon;

constexpr std::uint8_t out_endpoint = 2;
constexpr std::uint8_t in_endpoint = 1;
constexpr double hello_baud = 9600.0;
constexpr double load_baud = 3e6 / 21.0;
constexpr double run_baud = 1.5e6;
constexpr std::string_view hello = "\x0A\x43\x0D";
constexpr std::array<std::uint8_t, 4> answer{0x0A, 0x44, 0x2C, 0x0D};
constexpr std::uint8_t autobaud = 0x41;
constexpr std::int64_t frame_time_ns = 100'000;  // on the line, each way
constexpr int max_motor = 4096;
constexpr double lead_m = 0.03;

const Description& falcon() {
  // Class and endpoints as a generic FT232R tells them; the strings are an assumption, nobody reads them.
  static const Description description{
      .speed = Description::Speed::full,
      .device = {0x12, 0x01, 0x00, 0x02, 0x00, 0x00, 0x00, 0x08, 0x03, 0x04, 0x48, 0xCB, 0x00, 0x06, 0x01,
                 0x02, 0x03, 0x01},
      .configuration = {0x09, 0x02, 0x20, 0x00, 0x01, 0x01, 0x00, 0xA0, 0x2D, 0x09, 0x04,
                        0x00, 0x00, 0x02, 0xFF, 0xFF, 0xFF, 0x02, 0x07, 0x05, 0x81, 0x02,
                        0x40, 0x00, 0x00, 0x07, 0x05, 0x02, 0x02, 0x40, 0x00, 0x00},
      .strings = {"Kerf", "Falcon (emulated)", "KERF0001"},
      .reports = {}};
  return description;
}

}  // namespace

EmulatedFalcon::Options EmulatedFalcon::parse_options(drivers::Uri uri) {
  drivers::UriOptions given(std::move(uri));
  Options options;
  if (const auto firmware = given.text("firmware")) {
    if (*firmware != "loaded" && *firmware != "none") {
      throw drivers::DeviceError("firmware '" + *firmware + "': expected loaded or none");
    }
    options.loaded = *firmware == "loaded";
  }
  options.homed = given.flag("homed", options.homed);
  options.home_after_s = given.number("home_after", {"s", options.home_after_s, 0.0, 1e6});
  options.home_for_s = given.number("home_for", {"s", options.home_for_s, 0.0, 1e6});
  options.offset = static_cast<int>(given.number("offset", {"1", 0.0, -10000.0, 10000.0}));
  options.units_per_n_m = given.number("torque_scale", {"1", options.units_per_n_m, 1000.0, 30000.0});
  options.glitch = given.flag("glitch", options.glitch);
  options.sway_m = given.number("sway", {"m", options.sway_m, 0.0, 0.03});
  options.free = FreeTip::in(given);
  options.trace = given.text("trace").value_or("");
  given.refuse_others();
  return options;
}

EmulatedFalcon::EmulatedFalcon(const Options& options)
    : options_(options),
      boot_(options.loaded ? Boot::running : Boot::silent),
      // A cube of 8 cm that the arms reach in every corner.
      tip_({.centre_m = {0.0, 0.0, 0.12},
            .sway_m = options.sway_m,
            .max_travel_m = 0.04,
            .free = options.free}),
      homed_(options.homed),
      trace_(open_trace(options.trace,
                        "t_s,raw_1,raw_2,raw_3,motor_1,motor_2,motor_3,encoder_1,encoder_2,encoder_3,"
                        "x_m,y_m,z_m,homing,led")) {
  at_power_on_ = counts();
}

const Description& EmulatedFalcon::description() const { return falcon(); }

double EmulatedFalcon::seconds_at(std::int64_t now_ns) noexcept {
  if (start_ns_ < 0) start_ns_ = now_ns;
  return 1e-9 * static_cast<double>(now_ns - start_ns_);
}

bool EmulatedFalcon::line_runs_at(double baud) const noexcept {
  return std::abs(bridge_.baud() - baud) < 0.02 * baud;  // as far off as a line may be
}

std::optional<Bytes> EmulatedFalcon::control(const Setup& setup, std::span<const std::uint8_t>,
                                             std::int64_t now_ns) {
  (void)seconds_at(now_ns);
  Ftdi::Event event = Ftdi::Event::none;
  auto sent_back = bridge_.control(setup, event);
  if (event == Ftdi::Event::dtr_rose && line_runs_at(hello_baud)) {
    boot_ = Boot::listens;
    greeting_.clear();
  }
  if (event == Ftdi::Event::baud && line_runs_at(run_baud) && boot_ == Boot::loading) {
    const bool whole = image_.state() == drivers::c2000::Stream::State::finished;
    boot_ = whole ? Boot::running : Boot::silent;
  }
  return sent_back;
}

void EmulatedFalcon::receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes,
                             std::int64_t now_ns) {
  if (endpoint != out_endpoint) return;
  for (const std::uint8_t byte : bytes) {
    switch (boot_) {
      case Boot::silent:
        break;
      case Boot::listens:
      case Boot::greeted:
        take_greeting(byte, now_ns);
        break;
      case Boot::loading:
        take_image(byte, now_ns);
        break;
      case Boot::running:
        if (!line_runs_at(run_baud)) break;
        if (const auto frame = reader_.take(byte)) take_command(*frame, now_ns);
        break;
    }
  }
}

void EmulatedFalcon::take_greeting(std::uint8_t byte, std::int64_t now_ns) {
  if (line_runs_at(hello_baud)) {
    greeting_ += static_cast<char>(byte);
    if (!greeting_.ends_with(hello)) return;
    greeting_.clear();
    boot_ = Boot::greeted;
    const std::int64_t ready_ns = now_ns + bridge_.line_time_ns(hello.size() + answer.size());
    if (options_.glitch) bridge_.put(std::array<std::uint8_t, 1>{0x00}, ready_ns);
    bridge_.put(answer, ready_ns);
  } else if (line_runs_at(load_baud) && boot_ == Boot::greeted && byte == autobaud) {
    boot_ = Boot::loading;
    image_ = {};
    echoed_ns_ = now_ns + bridge_.line_time_ns(1);
    bridge_.put(std::array{byte}, echoed_ns_);
  }
}

void EmulatedFalcon::take_image(std::uint8_t byte, std::int64_t now_ns) {
  if (!line_runs_at(load_baud)) return;
  (void)image_.take(byte);
  echoed_ns_ = std::max(echoed_ns_, now_ns) + bridge_.line_time_ns(1);
  bridge_.put(std::array{byte}, echoed_ns_);
}

std::array<int, 3> EmulatedFalcon::counts() {
  const auto at = Falcon::angles(tip_.position());
  if (at && !stuck_) absolute_ = Falcon::counts_of(at->shoulder);
  return absolute_;
}

void EmulatedFalcon::home(bool asked, double time_s) {
  if (!asked) {
    homed_ = false;
    homing_since_s_ = -1.0;
  } else {
    if (homing_since_s_ < 0.0) homing_since_s_ = time_s;
    const double since_s = time_s - homing_since_s_;
    homed_ = homed_ || since_s >= options_.home_after_s;
    if (options_.home_for_s >= 0.0 && since_s > options_.home_after_s + options_.home_for_s) homed_ = false;
  }
  const bool leads = asked && !homed_;
  const bool outward = time_s - homing_since_s_ < 0.5 * options_.home_after_s;
  tip_.lead({0.0, 0.0, leads ? (outward ? lead_m : -lead_m) : 0.0});
}

void EmulatedFalcon::turn_motors(const std::array<int, 3>& asked, double time_s) {
  // Until the whole frame has come in, the motors do what they did.
  tip_.run_until(time_s);
  Eigen::Vector3d torque_n_m;
  for (std::size_t i = 0; i < 3; ++i) {
    motor_[i] = std::clamp(asked[i], -max_motor, max_motor);
    if (motor_[i] != asked[i]) ++clips_;
    torque_n_m[static_cast<Eigen::Index>(i)] = -motor_[i] / options_.units_per_n_m;
  }
  if (const auto at = Falcon::angles(tip_.position())) tip_.push(Falcon::force(torque_n_m, *at));
}

void EmulatedFalcon::take_command(const drivers::falcon::Frame& frame, std::int64_t now_ns) {
  const auto command = drivers::falcon::parse_command(frame);
  if (!command) return;
  const double time_s = seconds_at(now_ns + frame_time_ns);
  home(command->homing, time_s);
  turn_motors(command->motor, time_s);
  std::array<int, 3> encoder = counts();
  if (!homed_) {
    for (std::size_t i = 0; i < 3; ++i) encoder[i] += options_.offset - at_power_on_[i];
  }
  const drivers::falcon::Report report{
      .encoder = encoder, .homed = {homed_, homed_, homed_}, .centre = std::fmod(time_s, 2.0) >= 1.0};
  bridge_.put(drivers::falcon::encode(report), now_ns + 2 * frame_time_ns);
  ++frames_;
  if (!trace_.is_open()) return;
  const auto& raw = command->motor;
  const Eigen::Vector3d p = tip_.position();
  const char* led = command->red ? "red" : command->green ? "green" : command->blue ? "blue" : "off";
  trace_ << fmt::format("{:.9f},{},{},{},{},{},{},{},{},{},{:.9f},{:.9f},{:.9f},{},{}\n", time_s, raw[0],
                        raw[1], raw[2], motor_[0], motor_[1], motor_[2], encoder[0], encoder[1], encoder[2],
                        p.x(), p.y(), p.z(), command->homing ? 1 : 0, led);
}

std::optional<std::size_t> EmulatedFalcon::send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                                std::int64_t waits_since_ns, std::int64_t now_ns,
                                                Disturbance& next) {
  if (endpoint != in_endpoint) return std::nullopt;
  return bridge_.send(buffer, waits_since_ns, now_ns, next);
}

std::optional<std::int64_t> EmulatedFalcon::next_event_ns(std::int64_t) const {
  return bridge_.next_event_ns();
}

std::size_t EmulatedFalcon::preamble() const { return Ftdi::status_size; }

std::string EmulatedFalcon::tell() const {
  const char* firmware = "no firmware";
  if (boot_ == Boot::running) firmware = "firmware runs";
  if (boot_ == Boot::loading) firmware = "an image is half loaded";
  return fmt::format(
      "{}, {} frames answered, {} motor values clipped, {} bytes not of a frame, {} bytes purged or lost{}",
      firmware, frames_, clips_, reader_.dropped(), bridge_.lost(),
      image_.problem().empty() ? std::string() : fmt::format("; the image: {}", image_.problem()));
}

}  // namespace kerf::emulators

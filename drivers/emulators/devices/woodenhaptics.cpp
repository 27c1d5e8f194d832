#include "devices/woodenhaptics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <kerf/drivers/device.h>

#include "devices/woodenhaptics_wiring.h"
#include "trace.h"

namespace kerf::emulators {
namespace {

namespace wire = drivers::woodenhaptics;

constexpr std::int64_t frame_ns = 1'000'000;
constexpr std::int64_t watchdog_ns = 500'000'000;
constexpr std::int64_t push_ns = 250'000;   // so often the force follows the pose at a constant current
constexpr std::size_t hardware_orders = 2;  // the endpoint of V1 is buffered twice
constexpr double max_travel_m = 0.04;       // all models reach every corner of it

Description mbed(std::uint8_t size) {
  return {
      .speed = Description::Speed::full,
      .device = {0x12, 0x01, 0x00, 0x02, 0x00, 0x00, 0x00, 0x40, 0x34, 0x12, 0x06, 0x00, 0x01, 0x00, 0x01,
                 0x02, 0x03, 0x01},
      .configuration = {0x09, 0x02, 0x29, 0x00, 0x01, 0x01, 0x00, 0xC0, 0x00, 0x09, 0x04, 0x00, 0x00, 0x02,
                        0x03, 0x00, 0x00, 0x00, 0x09, 0x21, 0x11, 0x01, 0x00, 0x01, 0x22, 0x1B, 0x00, 0x07,
                        0x05, 0x81, 0x03, 0x40, 0x00, 0x01, 0x07, 0x05, 0x01, 0x03, 0x40, 0x00, 0x01},
      .strings = {"mbed.org", "HID DEVICE", "0123456789"},
      .reports = {{0x06, 0xAB, 0xFF, 0x0A, 0x00, 0x02, 0xA1, 0x01, 0x75, 0x08, 0x15, 0x00, 0x25, 0xFF,
                   0x95, size, 0x09, 0x01, 0x81, 0x02, 0x95, size, 0x09, 0x02, 0x91, 0x02, 0xC0}}};
}

Description teensy() {
  return {.speed = Description::Speed::full,
          .device = {0x12, 0x01, 0x00, 0x02, 0x00, 0x00, 0x00, 0x40, 0xC0, 0x16, 0x86, 0x04, 0x00, 0x01, 0x01,
                     0x02, 0x03, 0x01},
          .configuration = {0x09, 0x02, 0x49, 0x00, 0x02, 0x01, 0x00, 0xC0, 0x32, 0x09, 0x04, 0x00, 0x00,
                            0x02, 0x03, 0x00, 0x00, 0x00, 0x09, 0x21, 0x11, 0x01, 0x00, 0x01, 0x22, 0x1C,
                            0x00, 0x07, 0x05, 0x83, 0x03, 0x40, 0x00, 0x01, 0x07, 0x05, 0x04, 0x03, 0x40,
                            0x00, 0x01, 0x09, 0x04, 0x01, 0x00, 0x02, 0x03, 0x00, 0x00, 0x00, 0x09, 0x21,
                            0x11, 0x01, 0x00, 0x01, 0x22, 0x21, 0x00, 0x07, 0x05, 0x81, 0x03, 0x40, 0x00,
                            0x01, 0x07, 0x05, 0x02, 0x03, 0x20, 0x00, 0x02},
          .strings = {"Teensyduino", "Teensyduino RawHID", "1234560"},
          .reports = {{0x06, 0xAB, 0xFF, 0x0A, 0x00, 0x02, 0xA1, 0x01, 0x75, 0x08, 0x15, 0x00, 0x26, 0xFF,
                       0x00, 0x95, 0x40, 0x09, 0x01, 0x81, 0x02, 0x95, 0x40, 0x09, 0x02, 0x91, 0x02, 0xC0},
                      {0x06, 0xC9, 0xFF, 0x09, 0x04, 0xA1, 0x5C, 0x75, 0x08, 0x15, 0x00,
                       0x26, 0xFF, 0x00, 0x95, 0x40, 0x09, 0x75, 0x81, 0x02, 0x95, 0x20,
                       0x09, 0x76, 0x91, 0x02, 0x95, 0x04, 0x09, 0x76, 0xB1, 0x02, 0xC0}}};
}

struct Endpoints {
  std::uint8_t in;
  std::uint8_t out;
};
Endpoints endpoints_of(EmulatedWoodenHaptics::Generation generation) {
  return generation == EmulatedWoodenHaptics::Generation::v3 ? Endpoints{3, 4} : Endpoints{1, 1};
}

HeldTip::Options held(const EmulatedWoodenHaptics::Options& options) {
  return {.centre_m = options.model->centre_m,
          .sway_m = options.sway_m,
          .max_travel_m = max_travel_m,
          .free = options.free};
}

}  // namespace

EmulatedWoodenHaptics::Options EmulatedWoodenHaptics::parse_options(drivers::Uri uri) {
  drivers::UriOptions given(std::move(uri));
  Options options;
  const std::string generation = given.text("generation").value_or("v2");
  if (generation == "v1") {
    options.generation = Generation::v1;
  } else if (generation == "v3") {
    options.generation = Generation::v3;
  } else if (generation != "v2") {
    throw drivers::DeviceError("woody: option 'generation' is '" + generation + "', expected v1, v2 or v3");
  }
  const std::string model =
      given.text("model").value_or(options.generation == Generation::v3 ? "polhem-v3" : "woody-2019");
  options.model = mechanisms::WoodenHaptics::find(model);
  if (options.model == nullptr) {
    throw drivers::DeviceError("woody: option 'model' is '" + model +
                               "', expected woody-2016, woody-2019, aluhaptics or polhem-v3");
  }
  if (options.model->linkage && options.generation == Generation::v1) {
    throw drivers::DeviceError("woody: there is no " + model +
                               " with the reports of V1; expected generation=v2 or v3");
  }
  options.button_s = given.number("button", {"s", options.button_s, 0.0, 1e6});
  options.counter_offset = static_cast<int>(given.number("counter_offset", {"1", 0.0, -32768.0, 32767.0}));
  options.sway_m = given.number("sway", {"m", options.sway_m, 0.0, max_travel_m});
  options.free = FreeTip::in(given);
  options.trace = given.text("trace").value_or("");
  given.refuse_others();
  return options;
}

EmulatedWoodenHaptics::EmulatedWoodenHaptics(const Options& options)
    : options_(options),
      mechanism_(*options.model, wiring_of(options.generation, *options.model)),
      tip_(held(options)),
      trace_(open_trace(options.trace, "t_s,event,mA_a,mA_b,mA_c,enc_a,enc_b,enc_c,x,y,z,watchdog")) {
  counter_zero_.fill(options.counter_offset);
  std::fill(counter_zero_.begin() + 3, counter_zero_.end(), 0);
  trace_.precision(9);
}

const Description& EmulatedWoodenHaptics::description() const {
  static const Description v1 = mbed(0x08);
  static const Description v2 = mbed(0x0E);
  static const Description v3 = teensy();
  return options_.generation == Generation::v1 ? v1 : options_.generation == Generation::v2 ? v2 : v3;
}

std::optional<Bytes> EmulatedWoodenHaptics::control(const Setup& setup, std::span<const std::uint8_t>,
                                                    std::int64_t) {
  // Reading a report by the control endpoint gives zeros; writing one is taken.
  return Bytes((setup.request_type & 0x80U) != 0 ? setup.length : 0, 0);
}

void EmulatedWoodenHaptics::begin(std::int64_t now_ns) noexcept {
  start_ns_ = reached_ns_ = last_order_ns_ = now_ns;
}

double EmulatedWoodenHaptics::seconds_at(std::int64_t now_ns) const noexcept {
  return 1e-9 * static_cast<double>(now_ns - start_ns_);
}

/// The motors' force at the pose that there is, from the currents that they have.
void EmulatedWoodenHaptics::push_for(std::int64_t span_ns) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  if (const auto angles = mechanism_.angles_of(tip_.position())) {
    force = mechanism_.force({1e-3 * current_ma_[0], 1e-3 * current_ma_[1], 1e-3 * current_ma_[2]}, *angles);
  }
  tip_.push(force.allFinite() ? force : Eigen::Vector3d::Zero());
  reached_ns_ += span_ns;
  tip_.run_until(seconds_at(reached_ns_));
}

void EmulatedWoodenHaptics::run_until(std::int64_t now_ns) {
  if (start_ns_ < 0) {
    begin(now_ns);
    if (!streams()) build_report(now_ns);
  }
  while (reached_ns_ < now_ns) {
    std::int64_t until = std::min(now_ns, reached_ns_ + push_ns);
    const std::int64_t off_ns = last_order_ns_ + watchdog_ns;
    if (!watchdog_ && off_ns > reached_ns_) until = std::min(until, off_ns);
    push_for(until - reached_ns_);
    if (!watchdog_ && reached_ns_ >= off_ns) {
      watchdog_ = true;
      ++watchdog_trips_;
      set_currents({});
      note("watchdog");
    }
  }
  if (options_.button_s >= 0.0 && !button_pressed_ && seconds_at(now_ns) >= options_.button_s) {
    button_pressed_ = button_latched_ = true;
  }
}

std::array<int, 3> EmulatedWoodenHaptics::motor_counts() const {
  std::array<int, 3> whole{};
  if (const auto angles = mechanism_.angles_of(tip_.position())) {
    const auto counts = mechanism_.counts(*angles);
    for (std::size_t i = 0; i < 3; ++i) whole[i] = static_cast<int>(std::lround(counts[i]));
  }
  return whole;
}

void EmulatedWoodenHaptics::stick(bool stuck) {
  if (!stuck) {
    stuck_at_.reset();
  } else if (!stuck_at_) {
    stuck_at_ = counters();
  }
}

std::array<int, 6> EmulatedWoodenHaptics::counters() const {
  if (stuck_at_) return *stuck_at_;
  std::array<int, 6> all = counter_zero_;
  const auto motors = motor_counts();
  for (std::size_t i = 0; i < 3; ++i) all[i] += motors[i];
  for (int& one : all) one = wire::wrapped_difference(one, 0);
  return all;
}

void EmulatedWoodenHaptics::set_currents(const Currents& current_ma) {
  const int most = static_cast<int>(std::lround(1e3 * options_.model->max_current_a));
  for (std::size_t i = 0; i < 3; ++i) current_ma_[i] = std::clamp(current_ma[i], -most, most);
  if (current_ma_ != current_ma) ++cut_;
}

void EmulatedWoodenHaptics::apply(const Order& order, std::int64_t now_ns) {
  ++taken_;
  last_order_ns_ = now_ns;
  watchdog_ = false;
  set_currents(order.current_ma);
  if (order.preset) {
    const auto motors = motor_counts();
    counter_zero_ = order.counts;
    for (std::size_t i = 0; i < 3; ++i) counter_zero_[i] -= motors[i];
    button_latched_ = false;
  }
  note("order");
}

void EmulatedWoodenHaptics::receive(std::uint8_t endpoint, std::span<const std::uint8_t> bytes,
                                    std::int64_t now_ns) {
  if (endpoint != endpoints_of(options_.generation).out) return;
  run_until(now_ns);
  const auto order = wire::parse_order(bytes, options_.generation);
  if (!order) return;
  if (streams()) {
    // A third one would have to wait on the bus, and the host would send its newest then.
    if (orders_.size() == hardware_orders) {
      orders_.pop_back();
      ++overrun_;
    }
    orders_.push_back(*order);
  } else if (report_.empty()) {
    apply(*order, now_ns);
    build_report(now_ns);
  } else {
    orders_.assign(1, *order);
  }
}

void EmulatedWoodenHaptics::build_report(std::int64_t now_ns) {
  const auto input =
      wire::encode({.encoder = counters(), .button = button_latched_, .counter = streams() ? counter_++ : 0},
                   options_.generation);
  report_.assign(input.bytes.begin(), input.bytes.begin() + static_cast<std::ptrdiff_t>(input.size));
  for (std::size_t at = wire::report_size(Generation::v2); at < report_.size(); ++at) {
    noise_ = noise_ * 1664525U + 1013904223U;
    report_[at] = static_cast<std::uint8_t>(noise_ >> 24U);
  }
  reached_ns_ = std::max(reached_ns_, now_ns);
  note("report");
}

std::optional<std::size_t> EmulatedWoodenHaptics::send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                                       std::int64_t, std::int64_t now_ns, Disturbance& next) {
  if (endpoint != endpoints_of(options_.generation).in) return std::nullopt;
  run_until(now_ns);
  if (const auto size = wire_.send_rest(buffer)) return size;
  if ((!streams() && report_.empty()) || now_ns < next_report_ns_) return std::nullopt;
  next_report_ns_ = (now_ns / frame_ns + 1) * frame_ns;
  if (streams()) {
    if (!orders_.empty()) {
      apply(orders_.front(), now_ns);
      orders_.pop_front();
    }
    build_report(now_ns);
  }
  Bytes report = std::exchange(report_, {});
  ++reports_;
  if (!streams() && !orders_.empty()) {
    apply(orders_.back(), now_ns);
    orders_.clear();
    build_report(now_ns);
  }
  return wire_.send(std::move(report), buffer, next);
}

std::optional<std::int64_t> EmulatedWoodenHaptics::next_event_ns(std::int64_t) const {
  if (start_ns_ < 0) return std::nullopt;
  if (streams() || !report_.empty()) return next_report_ns_;
  return watchdog_ ? std::nullopt : std::optional(last_order_ns_ + watchdog_ns);
}

void EmulatedWoodenHaptics::note(const char* event) {
  if (!trace_.is_open()) return;
  const auto counts = counters();
  const Eigen::Vector3d at = tip_.position();
  trace_ << seconds_at(reached_ns_) << ',' << event << ',' << current_ma_[0] << ',' << current_ma_[1] << ','
         << current_ma_[2] << ',' << counts[0] << ',' << counts[1] << ',' << counts[2] << ',' << at[0] << ','
         << at[1] << ',' << at[2] << ',' << (watchdog_ ? 1 : 0) << '\n';
}

std::string EmulatedWoodenHaptics::tell() const {
  return std::to_string(reports_) + " reports sent, " + std::to_string(taken_) + " orders taken, " +
         std::to_string(overrun_) + " overrun, " + std::to_string(cut_) +
         " cut to the amplifiers' limit, watchdog " + std::to_string(watchdog_trips_) + " times";
}

}  // namespace kerf::emulators

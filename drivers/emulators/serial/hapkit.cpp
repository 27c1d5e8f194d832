#include "serial/hapkit.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <kerf/drivers/device.h>

namespace kerf::emulators {
namespace {

// Of sergiosierram/hapkit_ros; where the ends of the sensor are, of reitermarkus/hapkit.
constexpr double handle_radius_m = 0.09;
constexpr double pulley_radius_m = 0.005;
constexpr double sector_radius_m = 0.074;
constexpr double stall_torque_n_m = 0.03;
constexpr double count_m = handle_radius_m * 0.0148 * std::numbers::pi / 180.0;
constexpr double lower_end = 48.0;
constexpr double stop_m = handle_radius_m * std::numbers::pi / 4.0;

constexpr double frames_per_s = 1000.0;
constexpr double lines_per_s = 1000.0 / 30.0;
constexpr double makes_frame_s = 210e-6;  ///< from the sensor's value to the first byte
constexpr double held_s = 0.02;
constexpr double speed_corner_hz = 5.0;

std::uint16_t sum_over(const Bytes& bytes, std::size_t count) {
  boost::crc_optimal<16, 0x1021, 0xFFFF, 0, false, false> sum;
  sum.process_bytes(bytes.data(), count);
  return sum.checksum();
}

void append_word(Bytes& bytes, unsigned word) {
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U & 0xFFU));
}

}  // namespace

std::unique_ptr<EmulatedOnLine> EmulatedHapkit::make(drivers::UriOptions given, std::vector<Fault> faults) {
  const Options options = parse_common(given);
  const std::string firmware = given.text("firmware").value_or("kerf");
  if (firmware != "kerf" && firmware != "stream")
    throw drivers::DeviceError("hapkit: option 'firmware' is '" + firmware + "', expected kerf or stream");
  Own own{.prints = firmware == "stream"};
  own.boot_s = given.number("boot", {"s", own.prints ? 1.4 : 1.0, 0.0, 60.0});
  own.begins = given.number("begins", {"1", own.begins, 0.0, 923.0});
  own.noise = static_cast<int>(given.number("noise", {"1", 1.0, 0.0, 100.0}));
  own.flip = given.number("flip", {"1", own.flip, 700.0, 970.0});
  own.motor = given.number("motor", {"1", own.motor, -1.0, 1.0});
  const double button_s = given.number("button", {"s", -1.0, -1.0, 1e6});
  if (button_s >= 0.0) own.button_s = button_s;
  given.refuse_others();
  return std::make_unique<EmulatedHapkit>(options, own, std::move(faults));
}

EmulatedHapkit::EmulatedHapkit(const Options& options, const Own& own, std::vector<Fault> faults)
    : EmulatedSerialDevice(options, {.max_travel_m = stop_m}, std::move(faults), own.prints ? 2e6 : 5e5),
      own_(own) {
  boot_for(own.boot_s);
  stream(own.prints ? lines_per_s : frames_per_s, own.prints ? 0.0 : makes_frame_s);
  set_watchdog(held_s);
}

void EmulatedHapkit::begin_anew() {
  ticks_ = 0;
  heard_.clear();
  has_refused_ = is_cut_ = has_printed_ = false;
  ordered_s_.reset();
  place_.reset();
  order_ = 0;
  duty_ = flips_ = values_since_ = 0;
}

int EmulatedHapkit::sensor() {
  const double counts = position().x() / count_m + own_.begins;
  const double within = counts - own_.flip * std::floor(counts / own_.flip);
  const int wide = 2 * own_.noise + 1;
  const int noise = static_cast<int>(random_() % static_cast<unsigned>(wide)) - own_.noise;
  return std::clamp(static_cast<int>(std::floor(lower_end + within)) + noise, 0, 1023);
}

bool EmulatedHapkit::count_half_turns(int value) {
  const int step = value - place_.value_or(value);
  ++values_since_;
  const bool is_half_turn = std::abs(step) > 700;
  if (!is_half_turn && std::abs(step) > 128 * values_since_) return false;
  if (is_half_turn) flips_ += step > 0 ? -1 : 1;
  place_ = value;
  values_since_ = 0;
  return true;
}

Bytes EmulatedHapkit::binary_frame() {
  ++ticks_;
  const int value = sensor();
  unsigned status = 0;
  if (!ordered_s_ || world_s() - *ordered_s_ >= held_s) status |= 1U;
  if (!ordered_s_) status |= 2U;
  if (!count_half_turns(value)) status |= 4U;
  if (std::exchange(has_refused_, false)) status |= 8U;
  if (is_cut_ && (status & 1U) == 0) status |= 16U;
  Bytes bytes{0xA5, 1};
  append_word(bytes, ticks_);
  append_word(bytes, static_cast<unsigned>(value));
  bytes.push_back(static_cast<std::uint8_t>(flips_));
  bytes.push_back(static_cast<std::uint8_t>(status));
  bytes.push_back(order_);
  append_word(bytes, static_cast<std::uint16_t>(duty_));
  append_word(bytes, sum_over(bytes, bytes.size()));
  return bytes;
}

Bytes EmulatedHapkit::line() {
  std::string text;
  if (!std::exchange(has_printed_, true)) text = "Calibrated\nMin: -3041\nMax: 3040\nZero: 0\n";
  const bool is_pressed = own_.button_s && world_s() >= *own_.button_s;
  text += fmt::format("Prm {:.5f} {:.5f} {:.5f} {}\n", position().x(), speed_m_s_, acceleration_m_s2_,
                      is_pressed ? 1 : 0);
  return {text.begin(), text.end()};
}

Bytes EmulatedHapkit::frame() { return own_.prints ? line() : binary_frame(); }

/// A difference of places a millisecond apart, then one pole.
void EmulatedHapkit::moved() {
  const double passed_s = world_s() - speed_s_;
  if (!own_.prints || passed_s < 1.0 / frames_per_s) return;
  const double new_share = 1.0 - std::exp(-2.0 * std::numbers::pi * speed_corner_hz * passed_s);
  const double change = new_share * ((position().x() - speed_from_m_) / passed_s - speed_m_s_);
  speed_m_s_ += change;
  acceleration_m_s2_ += new_share * (change / passed_s - acceleration_m_s2_);
  speed_from_m_ = position().x();
  speed_s_ = world_s();
}

void EmulatedHapkit::hear(std::span<const std::uint8_t> bytes) {
  if (own_.prints) return;
  heard_.insert(heard_.end(), bytes.begin(), bytes.end());
  while (heard_.size() >= 6) {
    const unsigned told = heard_[4] | static_cast<unsigned>(heard_[5]) << 8U;
    if (heard_[0] != 0x5A || sum_over(heard_, 4) != told) {
      heard_.erase(heard_.begin());
      has_refused_ = true;
      continue;
    }
    const auto asked = static_cast<std::int16_t>(heard_[2] | heard_[3] << 8);
    order_ = heard_[1];
    heard_.erase(heard_.begin(), heard_.begin() + 6);
    duty_ = std::clamp<int>(asked, -255, 255);
    is_cut_ = duty_ != asked;
    ordered_s_ = world_s();
    feed_watchdog();
    const double share = duty_ / 255.0;
    const double torque_n_m = std::copysign(stall_torque_n_m * share * share, own_.motor * duty_);
    push({torque_n_m * sector_radius_m / (handle_radius_m * pulley_radius_m), 0.0, 0.0});
  }
}

}  // namespace kerf::emulators

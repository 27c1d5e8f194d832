#include "devices/spacemouse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace kerf::emulators {
namespace {

constexpr std::int64_t interval_ns = 8'000'000;
constexpr unsigned zero_reports = 6;  // three pairs when the cap is let go
constexpr std::array sway_hz{0.13, 0.19, 0.23, 0.29, 0.37, 0.41};

const Description& navigator() {
  // Byte for byte as a SpaceNavigator tells them, but for a speed that every virtual bus takes.
  static const Description description{
      .speed = Description::Speed::full,
      .device = {0x12, 0x01, 0x00, 0x02, 0x00, 0x00, 0x00, 0x08, 0x6D, 0x04, 0x26, 0xC6, 0x35, 0x04, 0x01,
                 0x02, 0x00, 0x01},
      .configuration = {0x09, 0x02, 0x29, 0x00, 0x01, 0x01, 0x00, 0x80, 0x32, 0x09, 0x04, 0x00, 0x00, 0x02,
                        0x03, 0x00, 0x00, 0x00, 0x09, 0x21, 0x11, 0x01, 0x00, 0x01, 0x22, 0xD9, 0x00, 0x07,
                        0x05, 0x81, 0x03, 0x08, 0x00, 0x0A, 0x07, 0x05, 0x02, 0x03, 0x08, 0x00, 0x0A},
      .strings = {"3Dconnexion", "SpaceNavigator"},
      .reports = {{
          0x05, 0x01, 0x09, 0x08, 0xA1, 0x01, 0xA1, 0x00, 0x85, 0x01, 0x16, 0xA2, 0xFE, 0x26, 0x5E, 0x01,
          0x36, 0x88, 0xFA, 0x46, 0x78, 0x05, 0x55, 0x0C, 0x65, 0x11, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32,
          0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xC0, 0xA1, 0x00, 0x85, 0x02, 0x09, 0x33, 0x09, 0x34, 0x09,
          0x35, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xC0, 0xA1, 0x02, 0x85, 0x03, 0x05, 0x01, 0x05, 0x09,
          0x19, 0x01, 0x29, 0x02, 0x15, 0x00, 0x25, 0x01, 0x35, 0x00, 0x45, 0x01, 0x75, 0x01, 0x95, 0x02,
          0x81, 0x02, 0x95, 0x0E, 0x81, 0x03, 0xC0, 0xA1, 0x02, 0x85, 0x04, 0x05, 0x08, 0x09, 0x4B, 0x15,
          0x00, 0x25, 0x01, 0x95, 0x01, 0x75, 0x01, 0x91, 0x02, 0x95, 0x01, 0x75, 0x07, 0x91, 0x03, 0xC0,
          0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x02, 0x15, 0x80, 0x25, 0x7F, 0x75, 0x08, 0x09, 0x3A, 0xA1,
          0x02, 0x85, 0x05, 0x09, 0x20, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x06, 0x09, 0x21,
          0x95, 0x01, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x07, 0x09, 0x22, 0x95, 0x01, 0xB1, 0x02, 0xC0,
          0xA1, 0x02, 0x85, 0x08, 0x09, 0x23, 0x95, 0x07, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x09, 0x09,
          0x24, 0x95, 0x07, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x0A, 0x09, 0x25, 0x95, 0x07, 0xB1, 0x02,
          0xC0, 0xA1, 0x02, 0x85, 0x0B, 0x09, 0x26, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x13,
          0x09, 0x2E, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xC0, 0xC0,
      }}};
  return description;
}

}  // namespace

EmulatedSpaceMouse::Options EmulatedSpaceMouse::parse_options(drivers::Uri uri) {
  drivers::UriOptions given(std::move(uri));
  Options options;
  options.amplitude = given.number("amplitude", {"1", options.amplitude, 0.0, 350.0});
  options.rest_s = given.number("rest", {"s", options.rest_s, 0.0, 1e6});
  given.refuse_others();
  return options;
}

const Description& EmulatedSpaceMouse::description() const { return navigator(); }

std::optional<Bytes> EmulatedSpaceMouse::control(const Setup& setup, std::span<const std::uint8_t>,
                                                 std::int64_t) {
  // Reading a feature: its number and zeros. Writing one (7 is "calibrate") is taken.
  if ((setup.request_type & 0x80U) == 0) return Bytes{};
  Bytes feature(std::max<std::size_t>(setup.length, 1), 0);
  feature[0] = static_cast<std::uint8_t>(setup.value);
  return feature;
}

void EmulatedSpaceMouse::receive(std::uint8_t, std::span<const std::uint8_t> bytes, std::int64_t) {
  if (bytes.size() >= 2 && bytes[0] == 4) lit_ = (bytes[1] & 1U) != 0;
}

Bytes EmulatedSpaceMouse::next_report(double time_s) {
  const bool rests = options_.rest_s > 0.0 && time_s >= options_.rest_s;
  const bool presses = !rests && std::fmod(time_s, 2.0) >= 1.0;
  if (turn_ == 2) {
    turn_ = 0;
    if (presses != pressed_) {
      pressed_ = presses;
      return {3, static_cast<std::uint8_t>(pressed_ ? 1 : 0), 0};
    }
  }
  if (rests && zeros_ >= zero_reports && turn_ == 0) return {};
  Bytes report{static_cast<std::uint8_t>(turn_ + 1)};
  for (std::size_t axis = 3U * turn_; axis < 3U * turn_ + 3U; ++axis) {
    const double turns = sway_hz[axis] * time_s;
    const double deflection = rests ? 0.0 : options_.amplitude * std::sin(2.0 * std::numbers::pi * turns);
    const auto number = static_cast<std::uint16_t>(std::lround(deflection));
    report.push_back(static_cast<std::uint8_t>(number & 0xFFU));
    report.push_back(static_cast<std::uint8_t>(number >> 8U));
  }
  zeros_ = rests ? zeros_ + 1 : 0;
  ++turn_;
  return report;
}

std::optional<std::size_t> EmulatedSpaceMouse::send(std::uint8_t endpoint, std::span<std::uint8_t> buffer,
                                                    std::int64_t, std::int64_t now_ns, Disturbance& next) {
  if (endpoint != 1) return std::nullopt;
  if (start_ns_ < 0) start_ns_ = due_ns_ = now_ns;
  if (const auto size = wire_.send_rest(buffer)) return size;
  if (now_ns < due_ns_) return std::nullopt;
  due_ns_ += interval_ns;
  if (due_ns_ <= now_ns) due_ns_ = now_ns + interval_ns;
  Bytes report = next_report(1e-9 * static_cast<double>(now_ns - start_ns_));
  if (report.empty()) return std::nullopt;
  ++reports_;
  return wire_.send(std::move(report), buffer, next);
}

std::optional<std::int64_t> EmulatedSpaceMouse::next_event_ns(std::int64_t) const {
  return start_ns_ < 0 ? std::nullopt : std::optional(due_ns_);
}

std::string EmulatedSpaceMouse::tell() const {
  return std::to_string(reports_) + " reports sent, LED " + (lit_ ? "on" : "off");
}

}  // namespace kerf::emulators

#include "kerf/drivers/spacemouse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "age_limits.h"
#include "kerf/mechanisms/angle.h"

namespace kerf::drivers {
namespace {

constexpr double full_deflection = 350.0;
constexpr int wait_ms = 50;
// A receiver has further interfaces, and a keypad is no cap: generic desktop, multi-axis controller.
constexpr usb::Usage cap{.page = 0x01, .usage = 0x08};

struct Model {
  std::uint16_t vendor;
  std::uint16_t product;
};
// Those that send the reports of the family; keyboards and mice of the same makers are left out.
constexpr std::array<Model, 20> models{
    {{0x046d, 0xc603}, {0x046d, 0xc605}, {0x046d, 0xc606}, {0x046d, 0xc623}, {0x046d, 0xc625},
     {0x046d, 0xc626}, {0x046d, 0xc627}, {0x046d, 0xc628}, {0x046d, 0xc629}, {0x046d, 0xc62b},
     {0x256f, 0xc62e}, {0x256f, 0xc62f}, {0x256f, 0xc631}, {0x256f, 0xc632}, {0x256f, 0xc633},
     {0x256f, 0xc635}, {0x256f, 0xc636}, {0x256f, 0xc638}, {0x256f, 0xc63a}, {0x256f, 0xc652}}};

/// The model and the index among its kind of the `number`-th cap.
std::pair<usb::Identity, std::size_t> find(std::size_t number) {
  const auto all = find_spacemice();
  if (number >= all.size()) {
    throw DeviceError("SpaceMouse: number " + std::to_string(number) + " is not attached (" +
                      std::to_string(all.size()) +
                      " found); plug it in, or start its emulator: kerf-emulate spacemouse");
  }
  const usb::Attached& one = all[number];
  const auto before = std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(number),
                                    [&](const usb::Attached& other) { return other.product == one.product; });
  return {{one.vendor, one.product, "SpaceMouse"}, static_cast<std::size_t>(before)};
}

AxisInfo axis(std::string name, bool turns, double travel) {
  return {.name = std::move(name),
          .position_unit = turns ? "rad" : "m",
          .force_unit = turns ? "N·m" : "N",
          .resolution = travel / full_deflection,
          .lower = -travel,
          .upper = travel};
}

DeviceInfo describe(std::string_view uri, const SpaceMouse::Options& options, const std::string& name) {
  const double reach = options.reach_m;
  const double swing = options.swing_rad;
  return {.uri = std::string(uri),
          .model = name,
          .about = std::string(SpaceMouse::about),
          .axes = {axis("x", false, reach), axis("y", false, reach), axis("z", false, reach),
                   axis("rx", true, swing), axis("ry", true, swing), axis("rz", true, swing)},
          .channels = {{.name = "report_age", .unit = "s"}, {.name = "buttons", .unit = "1"}},
          .report_jitter_s = max_report_jitter_s,
          .button_channel = 1,
          .configuration =
              "reach = " + std::to_string(reach) + " # m\nswing = " + std::to_string(swing) + " # rad\n"};
}

}  // namespace

std::vector<usb::Attached> find_spacemice() {
  auto all = usb::find_hid(0, 0, cap);
  std::erase_if(all, [](const usb::Attached& one) {
    return std::ranges::none_of(models, [&](const Model& model) {
      return model.vendor == one.vendor && model.product == one.product;
    });
  });
  return all;
}

SpaceMouse::Options SpaceMouse::parse_options(Uri uri) {
  UriOptions given(std::move(uri));
  Options options;
  options.reach_m = given.number("reach", {"m", options.reach_m, 1e-6, 10.0});
  options.swing_rad = given.number("swing", {"deg", options.swing_rad, 1e-6, 360.0 * degree});
  given.refuse_others();
  return options;
}

SpaceMouse::SpaceMouse(std::string_view uri, std::size_t number, const Options& options)
    : options_(options),
      device_([&] {
        const auto [identity, index] = find(number);
        return usb::HidDevice(identity, index, cap);
      }()),
      opened_ns_(usb::now_ns()) {
  info_ = describe(uri, options, device_.name());
  report_.at_ns = opened_ns_;
  thread_.start([this](const std::stop_token& stop) { listen(stop); });
}

void SpaceMouse::listen(const std::stop_token& stop) noexcept {
  std::array<std::uint8_t, 64> bytes{};
  Report report;
  while (!stop.stop_requested()) {
    const int size = device_.read(bytes, wait_ms);
    if (size < 0) {
      lost_.store(true);
      return;  // not again and again: the kernel needs the processor to take the device away
    }
    if (size == 0) continue;
    if (!spacemouse::take_report(std::span(bytes).first(static_cast<std::size_t>(size)), report.state)) {
      refused_.fetch_add(1, std::memory_order_relaxed);
      continue;
    }
    report.at_ns = usb::now_ns();
    latest_.put(report);
    reports_.fetch_add(1, std::memory_order_relaxed);
  }
}

Status SpaceMouse::read(double now_s, Sample& sample) noexcept {
  if (lost_.load(std::memory_order_relaxed)) return Status::lost;
  (void)latest_.take(report_);
  const auto& raw = report_.state.axis;
  // From right, towards the user, down to right, away from the user, up; pitch, roll and yaw turn with their
  // axes.
  constexpr std::array<double, max_axes> sign{1.0, -1.0, -1.0, 1.0, -1.0, -1.0};
  for (std::size_t at = 0; at < max_axes; ++at) {
    const double travel = at < 3 ? options_.reach_m : options_.swing_rad;
    sample.position[at] = sign[at] * travel * raw[at] / full_deflection;
    sample.velocity[at] = velocity_.update(at, sample.position[at], now_s);
  }
  velocity_.advance(now_s);
  sample.age_s = 1e-9 * static_cast<double>(usb::now_ns() - report_.at_ns);
  sample.channels[0] = sample.age_s;
  sample.channels[1] = report_.state.buttons;
  return Status::ok;
}

Status SpaceMouse::write(const Axes& force) noexcept {
  for (const double one : force) {
    if (!std::isfinite(one)) return Status::fault;
  }
  return lost_.load(std::memory_order_relaxed) ? Status::lost : Status::ok;
}

std::vector<Figure> SpaceMouse::figures() const {
  const double seconds = 1e-9 * static_cast<double>(usb::now_ns() - opened_ns_);
  const auto reports = static_cast<double>(reports_.load());
  return {{"report_rate", seconds > 0.0 ? reports / seconds : 0.0, "Hz"},
          {"reports", reports, "1"},
          {"malformed", static_cast<double>(refused_.load()), "1"}};
}

}  // namespace kerf::drivers

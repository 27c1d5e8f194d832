#include "kerf/drivers/falcon.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "age_limits.h"
#include "falcon/falcon_link.h"
#include "falcon/falcon_setup.h"
#include "interruption.h"
#include "kerf/drivers/protocols/falcon.h"
#include "kerf/mechanisms/falcon.h"

namespace kerf::drivers {
namespace {

constexpr std::size_t axis_count = 3;
constexpr std::chrono::milliseconds pause(2);
constexpr std::array<std::pair<std::string_view, Falcon::Led>, 4> leds{{{"off", Falcon::Led::off},
                                                                        {"red", Falcon::Led::red},
                                                                        {"green", Falcon::Led::green},
                                                                        {"blue", Falcon::Led::blue}}};

AxisInfo axis(std::string name, double lower, double upper) {
  return {.name = std::move(name),
          .position_unit = "m",
          .force_unit = "N",
          .resolution = 0.05e-3,  // along z at 0.12 m, where each arm moves by one count
          .lower = lower,
          .upper = upper,
          .force_limit = 9.0,  // "more than 2 lbf" of its data sheet
          .slew_limit = 2000.0,
          .speed_limit = 5.0,
          .acceleration_limit = 200.0};
}

std::string configuration_of(const Falcon::Options& options) {
  const auto* led = std::ranges::find(leds, options.led, [](const auto& one) { return one.second; });
  return fmt::format(
      "torque_scale = {} # motor units per N·m of an arm, not settled: 10000 of libnifalcon, 6616 of Martin "
      "and "
      "Hillier, 3500 to 5500 fitted to force vectors of the maker's SDK; forces in N are nominal\n"
      "degrees_at_zero = {} # of an arm, disputed: 35 of libnifalcon, 40 measured by an independent author, "
      "50 of "
      "Martin and Hillier\n"
      "degrees_per_count = {} # 1280 counts a turn of the motor, gain 7.719\n"
      "homing = {} # without it counts are from where the knob stood at power-on\n"
      "led = \"{}\"\n",
      options.units_per_n_m, mechanisms::Falcon::degrees_at_zero, mechanisms::Falcon::degrees_per_count,
      options.homing, led->first);
}

DeviceInfo describe(std::string_view uri, const Falcon::Options& options) {
  return {.uri = std::string(uri),
          .model = "Novint Falcon",
          .about = std::string(Falcon::about),
          .axes = {axis("x", -0.05, 0.05), axis("y", -0.05, 0.05), axis("z", 0.075, 0.175)},
          .channels = {{.name = "buttons", .unit = "1"},
                       {.name = "motor_1", .unit = "1"},
                       {.name = "motor_2", .unit = "1"},
                       {.name = "motor_3", .unit = "1"},
                       {.name = "report_age", .unit = "s"}},
          .report_jitter_s = max_report_jitter_s,
          .button_channel = 0,
          .configuration = configuration_of(options)};
}

Falcon::Led led_of(const std::string& name) {
  const auto* found = std::ranges::find(leds, name, [](const auto& one) { return one.first; });
  if (found == leds.end()) throw DeviceError("led '" + name + "': expected red, green, blue or off");
  return found->second;
}

}  // namespace

std::vector<usb::Attached> find_falcons() {
  return usb::find_usb(falcon_identity.vendor, falcon_identity.product);
}

Falcon::Options Falcon::parse_options(Uri uri) {
  UriOptions given(std::move(uri));
  Options options;
  options.firmware = given.file("firmware").value_or("");
  options.homing = given.flag("homing", options.homing);
  options.homing_timeout_s = given.number("homing_timeout", {"s", options.homing_timeout_s, 0.1, 3600.0});
  if (const auto led = given.text("led")) options.led = led_of(*led);
  options.units_per_n_m = given.number("torque_scale", {"1", options.units_per_n_m, 1000.0, 30000.0});
  given.refuse_others();
  return options;
}

Falcon::Falcon(std::string_view uri, std::size_t number, const Options& options,
               const std::atomic<bool>* stop)
    : options_(options), info_(describe(uri, options)), device_(falcon_identity, number) {
  info_.serial = device_.serial();
  info_.port = device_.port();
  set_up_falcon(device_, {.uri = uri, .firmware = options.firmware, .homing = options.homing, .stop = stop});
  guard_.emplace(falcon_identity.what, device_.descriptor(), falcon::letting_go(falcon_out, options.homing));
  link_ = std::make_unique<FalconLink>(device_, thread_, *guard_, options.homing, options.led);
  thread_.start([this](const std::stop_token& token) { link_->run(token); });
  wait_for_report(stop);
  if (options.homing) wait_until_homed(stop);
}

Falcon::~Falcon() = default;

void Falcon::wait_for_report(const std::atomic<bool>* stop) {
  const std::int64_t until_ns = usb::now_ns() + max_silence_ns;
  while (link_->take().at_ns == 0) {
    refuse_if_stopped(falcon_identity.what, stop);
    if (link_->lost() || usb::now_ns() > until_ns) {
      throw DeviceError(fmt::format("{}: it answered and then fell silent; unplug it and plug it in again",
                                    falcon_identity.what));
    }
    std::this_thread::sleep_for(pause);
  }
}

void Falcon::wait_until_homed(const std::atomic<bool>* stop) {
  const std::int64_t until_ns = usb::now_ns() + static_cast<std::int64_t>(1e9 * options_.homing_timeout_s);
  // A report from before would still count from elsewhere; and it may lose its homing again.
  const auto homed = [](const FalconLink::Reading& reading) {
    return std::ranges::all_of(reading.report.homed, [](bool one) { return one; });
  };
  while (!link_->homed() || !homed(link_->take())) {
    refuse_if_stopped(falcon_identity.what, stop);
    if (link_->lost()) {
      throw DeviceError(
          fmt::format("{}: it was unplugged before it was homed; plug it in again", falcon_identity.what));
    }
    if (usb::now_ns() > until_ns) {
      throw DeviceError(fmt::format(
          "{}: it was not homed within {} s; while its light is red, pull the knob fully out and push it "
          "fully in, or leave it relative: {}?homing=off",
          falcon_identity.what, options_.homing_timeout_s, info_.uri.substr(0, info_.uri.find('?'))));
    }
    std::this_thread::sleep_for(pause);
  }
}

Status Falcon::read(double, Sample& sample) noexcept {
  const FalconLink::Reading& reading = link_->take();
  const std::int64_t age_ns = usb::now_ns() - reading.at_ns;
  if (link_->lost() || age_ns > max_silence_ns) return Status::lost;
  std::ranges::copy(reading.knob, sample.position.begin());
  velocity_.update(sample.position, reading.at_ns, info_);
  for (std::size_t at = 0; at < axis_count; ++at) sample.velocity[at] = velocity_.velocity(at);
  sample.age_s = 1e-9 * static_cast<double>(age_ns);
  const falcon::Report& report = reading.report;
  sample.channels[0] =
      (report.plus ? 1 : 0) | (report.forward ? 2 : 0) | (report.centre ? 4 : 0) | (report.minus ? 8 : 0);
  for (std::size_t i = 0; i < axis_count; ++i) sample.channels[1 + i] = reading.motor[i];
  sample.channels[4] = sample.age_s;
  sample.faults = limited_ ? force_was_limited : 0U;
  const bool knows_where = reading.reachable && (!options_.homing || link_->homed());
  return knows_where && age_ns <= max_reading_age_ns ? Status::ok : Status::fault;
}

Status Falcon::write(const Axes& force) noexcept {
  const bool finite = std::ranges::all_of(force, [](double one) { return std::isfinite(one); });
  Eigen::Vector3d wanted;
  for (std::size_t at = 0; at < axis_count; ++at) {
    const double limit = info_.axes[at].force_limit;
    wanted[static_cast<Eigen::Index>(at)] = std::clamp(force[at], -limit, limit);
  }
  const auto& knob = link_->taken().knob;
  const auto at = mechanisms::Falcon::angles({knob[0], knob[1], knob[2]});
  const bool good = at && finite;
  falcon::Motors motors;
  if (good) {
    const auto torque = mechanisms::Falcon::torques(wanted, *at);
    motors = falcon::motors_for({torque[0], torque[1], torque[2]}, options_.units_per_n_m);
  }
  limited_ = motors.limited;
  if (limited_) limited_ticks_.fetch_add(1, std::memory_order_relaxed);
  link_->command(motors.value);
  if (link_->lost()) return Status::lost;
  return good && guard_->lives() ? Status::ok : Status::fault;
}

void Falcon::release(double) noexcept { link_->release(); }

std::vector<Figure> Falcon::figures() const {
  const auto& counts = link_->counts();
  const auto first_ns = counts.first_command_ns.load();
  const double seconds = 1e-9 * static_cast<double>(usb::now_ns() - first_ns);
  const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
  const double since = number(counts.reports.load() - counts.reports_before.load());
  return {{"report_rate", first_ns > 0 && seconds > 0.0 ? since / seconds : 0.0, "Hz"},
          {"reports", number(counts.reports.load()), "1"},
          {"resent", number(counts.resent.load()), "1"},
          {"dropped_bytes", number(counts.dropped_bytes.load()), "1"},
          {"malformed", number(counts.malformed.load()), "1"},
          {"motor_limited", number(limited_ticks_.load()), "1"}};
}

}  // namespace kerf::drivers

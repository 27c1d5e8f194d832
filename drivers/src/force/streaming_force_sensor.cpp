#include "kerf/drivers/streaming_force_sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <poll.h>

#include "age_limits.h"
#include "kerf/drivers/device_notes.h"
#include "kerf/drivers/force_calibration.h"

namespace kerf::drivers {
namespace {

constexpr std::int64_t ask_again_ns = 100'000'000;
constexpr int most_questions = 10;
constexpr std::int64_t rate_window_ns = 300'000'000;
constexpr int rate_windows = 5;
constexpr double rate_tolerance = 0.02;  // of the rate told, by what arrives in that window
constexpr double least_steps = 10.0;     // with fewer it cannot be told
constexpr double rate_error = 0.005;     // of what arrives in that window, at most
constexpr std::uint64_t wrong_frames_of_a_storm = 10;

double rate_of(double frames, std::int64_t span_ns) noexcept {
  return span_ns > 0 ? frames / (1e-9 * static_cast<double>(span_ns)) : 0.0;
}

}  // namespace

std::vector<ForceMount> parse_mounts(std::string_view text) {
  const auto refuse = [&](std::string_view one) {
    throw DeviceError(fmt::format(
        "axes={}: '{}' is no mount; expected AXIS:COMPONENT with - before a component that acts "
        "the other way and /LEVER behind one of another kind, for example theta:-tz/36.9mm,x_s:fx",
        text, one));
  };
  std::vector<ForceMount> mounts;
  for (std::string_view rest = text; !rest.empty();) {
    const auto end = std::min(rest.find(','), rest.size());
    const std::string_view one = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const auto colon = one.find(':');
    if (colon == std::string_view::npos || colon == 0) refuse(one);
    ForceMount mount{.axis = std::string(one.substr(0, colon))};
    const std::string_view component = one.substr(colon + 1);
    const auto slash = std::min(component.find('/'), component.size());
    if (slash < component.size()) {
      const Uri lever{.name = "force sensor",
                      .options = {{"lever", std::string(component.substr(slash + 1))}}};
      mount.lever_m = UriOptions(lever).number("lever", {"m", 0.0, 1e-4, 10.0});
    }
    const auto found = signed_component(component.substr(0, slash));
    if (!found) refuse(one);
    mount.component = found->component;
    mount.sign = found->sign;
    mounts.push_back(std::move(mount));
  }
  return mounts;
}

StreamingForceSensor::Options StreamingForceSensor::parse_options(UriOptions& given) {
  Options options;
  const std::string rule = given.text("resample").value_or("latest");
  if (rule != "latest" && rule != "interpolated")
    throw DeviceError(fmt::format("resample={}: expected latest or interpolated", rule));
  if (rule == "interpolated") options.rule = StreamedForce::Rule::interpolated;
  const double delay = given.number("delay", {"s", 0.0, 0.0, 0.02});
  if (delay > 0.0) options.delay_s = delay;
  if (delay > 0.0 && options.rule == StreamedForce::Rule::latest)
    throw DeviceError("delay: the latest reading has none of its own; say resample=interpolated too");
  if (const auto axes = given.text("axes")) options.mounts = parse_mounts(*axes);
  return options;
}

StreamingForceSensor::StreamingForceSensor(std::string_view uri, std::unique_ptr<ForceSource> source,
                                           const Options& options)
    : uri_(uri), source_(std::move(source)), intake_(source_->describe().channels.size()) {
  wait_for_frames();
  const double rate_hz = find_rate();
  describe(options, rate_hz);
  intake_.begin(rate_hz);
  thread_.start([this](const std::stop_token& stop) { stream(stop); });
}

StreamingForceSensor::~StreamingForceSensor() {
  thread_.stop();
  source_->end();
}

std::string StreamingForceSensor::trouble() const {
  return intake_.ended() ? source_->silence(intake_.wrong_in_a_row()) : std::string();
}

void StreamingForceSensor::refuse(const std::string& why) const {
  source_->end();
  throw DeviceError(fmt::format("{}: {}", uri_, why));
}

void StreamingForceSensor::wait_for_frames() {
  for (int question = 0; question < most_questions; ++question) {
    source_->ask();
    const std::int64_t until = usb::now_ns() + ask_again_ns;
    for (std::int64_t now = usb::now_ns(); now < until; now = usb::now_ns()) {
      wait_and_take(until - now);
      if (intake_.frames() > 0) return;
      if (intake_.wrong_in_a_row() >= wrong_frames_of_a_storm)
        refuse(source_->silence(intake_.wrong_in_a_row()));
    }
  }
  refuse(source_->silence(intake_.wrong_in_a_row()));
}

double StreamingForceSensor::find_rate() {
  const auto arrived = [&] { return static_cast<double>(intake_.frames() + intake_.lost()); };
  const double before = arrived();
  const std::int64_t start = intake_.last_ns();
  double found = 0.0;
  bool is_known = false;
  const auto fits = [&](std::optional<double> rate) {
    return rate && (!is_known || std::abs(found / *rate - 1.0) < rate_tolerance);
  };
  // A thread that was held up makes one window wrong, and the next one right.
  for (int window = 0; window < rate_windows; ++window) {
    const double before_window = arrived();
    const std::int64_t begin = intake_.last_ns();
    const std::int64_t until = usb::now_ns() + rate_window_ns;
    for (std::int64_t now = usb::now_ns(); now < until; now = usb::now_ns()) wait_and_take(until - now);
    found = rate_of(arrived() - before_window, intake_.last_ns() - begin);
    is_known = arrived() - before_window >= least_steps;
    if (const auto told = source_->told_rate_hz(); fits(told))
      return is_known && std::abs(found / *told - 1.0) > rate_error ? found : *told;
  }
  found = rate_of(arrived() - before, intake_.last_ns() - start);
  if (const auto near = source_->rate_near(found); is_known && fits(near)) return *near;
  const auto told = source_->told_rate_hz();
  refuse(fmt::format(
      "{:.0f} frames a second arrive, and {}; give the rate that it is set to, for example rate=1000Hz",
      found, told ? fmt::format("{:g} were told", *told) : std::string("it does not say how many")));
}

void StreamingForceSensor::describe(const Options& options, double rate_hz) {
  const bool interpolated = options.rule == StreamedForce::Rule::interpolated;
  const double delay = interpolated ? options.delay_s.value_or(2.0 / rate_hz) : 0.0;
  intake_.force().resample(options.rule, delay);
  info_ = source_->describe();
  info_.uri = uri_;
  info_.axes = sensor_axes();
  info_.measures_force = true;
  info_.mounts = options.mounts;
  info_.channels.insert(info_.channels.begin(), {{.name = "force_age", .unit = "s"},
                                                 {.name = "force_scan", .unit = "1"},
                                                 {.name = "force_lost", .unit = "1"}});
  info_.configuration += fmt::format("rate = {} # Hz\nresample = \"{}\"\ndelay = {} # s\n", rate_hz,
                                     interpolated ? "interpolated" : "latest", delay);
  if (intake_.last_health() != ForceHealth::sound) {
    note_device(fmt::format("{}: {}: its forces are left out until it is well", uri_, source_->trouble()));
  }
}

void StreamingForceSensor::wait_and_take(std::int64_t most_ns) noexcept {
  std::array<pollfd, 2> wanted{{{.fd = source_->descriptor(), .events = POLLIN, .revents = 0},
                                {.fd = thread_.wake_descriptor(), .events = POLLIN, .revents = 0}}};
  const timespec most{.tv_sec = most_ns / 1'000'000'000, .tv_nsec = most_ns % 1'000'000'000};
  ppoll(wanted.data(), wanted.size(), &most, nullptr);
  source_->take(intake_);
}

void StreamingForceSensor::stream(const std::stop_token& stop) noexcept {
  const std::int64_t began_ns = usb::now_ns();
  std::int64_t asked_ns = began_ns;
  while (!stop.stop_requested() && !intake_.force().lost()) {
    wait_and_take(20'000'000);
    const std::int64_t now = usb::now_ns();
    const std::int64_t silent_ns = now - std::max(began_ns, intake_.last_ns());
    if (silent_ns > max_silence_ns || intake_.wrong_in_a_row() >= wrong_frames_of_a_storm)
      intake_.force().lose();
    if (silent_ns <= ask_again_ns || now - asked_ns < ask_again_ns) continue;
    source_->ask();
    asked_ns = now;
  }
}

}  // namespace kerf::drivers

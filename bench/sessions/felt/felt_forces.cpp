#include "felt/felt_forces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/fitting/jnd.h>

#include "felt/led_hand.h"
#include "felt/vibration.h"
#include "laws/placement.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

constexpr double soft_start_s = 0.5;

std::string with_seed(const std::string& uri, std::size_t seed) {
  return fmt::format("{}{}seed={}", uri, uri.find('?') == std::string::npos ? '?' : '&', seed);
}

bool fits(const Protocol& protocol, const drivers::DeviceInfo& device) {
  return std::ranges::all_of(protocol.samples, [&](const SessionSample& sample) {
    try {
      (void)axes_for(sample.law, device);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  });
}

std::string first_that_fits(const Protocol& protocol) {
  for (const drivers::DeviceInfo& device : drivers::list_devices()) {
    if (device.simulated && fits(protocol, device)) return device.uri;
  }
  throw std::invalid_argument(fmt::format(
      "no simulated device has the axes of all samples of '{}'; give one with --device, or --open-loop",
      protocol.name));
}

/// From the ticks past the soft start.
class FeltRows {
 public:
  FeltRows(const drivers::DeviceInfo& device, std::size_t ticks, FeltForces& felt) : felt_(felt) {
    felt_.axes = device.axes.size();
    felt_.begins.push_back(felt_.ticks());
    felt_.force_n.reserve(felt_.force_n.size() + ticks * felt_.axes);
    for (const drivers::AxisInfo& axis : device.axes)
      newtons_.push_back(1.0 / fitting::felt_lever(axis.force_unit));
  }
  /// What a guide adds in this tick, which is none of the law's.
  void take_off(std::size_t axis, double force) noexcept { guide_ = {axis, force}; }
  void take(const schema::Row& row) {
    if (row.time_s < soft_start_s || felt_.force_n.size() + felt_.axes > felt_.force_n.capacity()) return;
    for (std::size_t axis = 0; axis < felt_.axes; ++axis)
      felt_.force_n.push_back(newtons_[axis] *
                              (row.force_commanded[axis] - (axis == guide_.first ? guide_.second : 0.0)));
    if ((row.flags & (schema::flag_force_limited | schema::flag_slew_limited)) != 0) ++felt_.limited_ticks;
  }

 private:
  FeltForces& felt_;
  std::vector<double> newtons_;
  std::pair<std::size_t, double> guide_{0, 0.0};  ///< axis and force
};

/// The guide's force beside that of a law, from the first tick on.
OtherRendering with_guide(OtherRendering law, const GuidedMotion& guide, std::size_t axis, FeltRows& rows) {
  return {.step = [law = std::move(law), guide, axis, &rows, time_s = 0.0](const drivers::Sample& now,
                                                                           double period_s) mutable {
    Command command = law.step(now, period_s);
    const double force = guide.pull(guide.at(time_s), now.position[axis], now.velocity[axis]);
    time_s += period_s;
    rows.take_off(axis, force);
    command.force[axis] += force;
    return command;
  }};
}

}  // namespace

double FeltForces::magnitude_n(std::size_t tick) const noexcept {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < axes; ++axis) squared += std::pow(force_n[tick * axes + axis], 2);
  return std::sqrt(squared);
}

double FeltForces::rms_n(double above_n) const noexcept {
  double sum = 0.0;
  std::size_t in_contact = 0;
  for (std::size_t tick = 0; tick < ticks(); ++tick) {
    const double magnitude = magnitude_n(tick);
    if (magnitude <= above_n) continue;
    sum += magnitude * magnitude;
    ++in_contact;
  }
  return in_contact == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(in_contact));
}

double FeltForces::peak_n() const noexcept {
  double peak = 0.0;
  for (std::size_t tick = 0; tick < ticks(); ++tick) peak = std::max(peak, magnitude_n(tick));
  return peak;
}

FeltLevel FeltForces::level() const {
  FeltLevel level{.rms_n = rms_n(least_felt_force_n),
                  .peak_n = peak_n(),
                  .limited_share = static_cast<double>(limited_ticks) /
                                   static_cast<double>(std::max<std::size_t>(1, ticks()))};
  VibrationMeter meter(axes, rate_hz);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : ticks();
    meter.add(std::span(force_n).subspan(begins[i] * axes, (end - begins[i]) * axes));
  }
  meter.put_into(level);
  return level;
}

FeltRenderer::FeltRenderer(const Protocol& protocol, const FeltOptions& options)
    : protocol_(&protocol),
      device_uri_(options.device_uri.empty() ? protocol.device_uri : options.device_uri) {
  if (device_uri_.empty() && !options.open_loop) device_uri_ = first_that_fits(protocol);
  if (options.stand_in && !options.open_loop && !device_uri_.empty() && !device_uri_.starts_with("sim:"))
    stands_for_ = std::exchange(device_uri_, first_that_fits(protocol));
  if (options.open_loop || !device_uri_.starts_with("sim:")) device_uri_.clear();
  if (is_open_loop() && !protocol.motion) {
    throw std::invalid_argument(
        fmt::format("protocol '{}' has no [motion], along which forces could be rendered without a simulated "
                    "device; add one, or give --device sim:...",
                    protocol.name));
  }
  if (protocol.motion) seconds_ = protocol.motion->seconds.value_or(seconds_);
  if (options.seconds > 0.0) seconds_ = options.seconds;
  if (protocol.guide && protocol.guide->leads(false)) device_uri_ = led_hand(device_uri_, protocol);
  if (device_uri_.find("seed=") == std::string::npos)
    renderings_ = std::max<std::size_t>(1, options.renderings);
  if (seconds_ < 2.0 * soft_start_s) {
    throw std::invalid_argument(fmt::format(
        "samples are to be felt for {:g} s, expected at least {:g} s: the first {:g} s are left out",
        seconds_, 2.0 * soft_start_s, soft_start_s));
  }
}

FeltForces FeltRenderer::rendered(const PlayedLaw& law) const {
  if (is_open_loop()) return along_motion(law);
  FeltForces felt{.rate_hz = protocol_->rate_hz};
  for (std::size_t i = 1; i <= renderings_; ++i)
    render_once(law, renderings_ == 1 ? device_uri_ : with_seed(device_uri_, i), felt);
  return felt;
}

void FeltRenderer::render_once(const PlayedLaw& law, const std::string& uri, FeltForces& felt) const {
  std::optional<FeltRows> rows;
  const std::atomic<bool> stop{false};
  const RunOptions options{
      .device_uri = uri,
      .seconds = seconds_,
      .rate_hz = protocol_->rate_hz,
      .virtual_time = true,
      .rendering =
          [&](const drivers::DeviceInfo& device) {
            rows.emplace(device, static_cast<std::size_t>(seconds_ * protocol_->rate_hz) + 1, felt);
            OtherRendering rendering = rendering_of(law, device);
            const auto& guide = protocol_->guide;
            if (!guide || !guide->felt || !guide->leads(false)) return rendering;
            return with_guide(std::move(rendering), *guide, axes_for(law.law, device).front(), *rows);
          },
      .each_row = [&](const schema::Row& row) { rows->take(row); },
      .ramp_s = std::min(protocol_->ramp_s, soft_start_s),
  };
  const LoopReport report = run_on_device(options, stop).report;
  if (const auto faults = report.ticks_with(schema::flag_law_fault); faults > 0) {
    throw std::invalid_argument(fmt::format("law '{}' gives no finite force on {} in {} of {} ticks",
                                            law.law.law.model(), uri, faults, report.ticks()));
  }
}

FeltForces FeltRenderer::along_motion(const PlayedLaw& law) const {
  const auto law_axes = axes_of(law.law);
  FeltForces felt{.axes = law_axes.size(),
                  .rate_hz = protocol_->rate_hz,
                  .force_n = forces_along(*protocol_, law),
                  .begins = {0}};
  for (std::size_t i = 0; i < felt.force_n.size(); ++i)
    felt.force_n[i] *= 1.0 / fitting::felt_lever(law_axes[i % felt.axes].force_unit);
  return felt;
}

}  // namespace kerf::bench

#include "observers/felt_forces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/fitting/jnd.h>

#include "laws/placement.h"
#include "protocol/samples.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

constexpr double soft_start_s = 0.5;
constexpr double no_force_n = 1e-9;

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
    felt_.force_n.reserve(felt_.force_n.size() + ticks * felt_.axes);
    for (const drivers::AxisInfo& axis : device.axes)
      newtons_.push_back(1.0 / fitting::felt_lever(axis.force_unit));
  }
  void take(const schema::Row& row) {
    if (row.time_s < soft_start_s || felt_.force_n.size() + felt_.axes > felt_.force_n.capacity()) return;
    for (std::size_t axis = 0; axis < felt_.axes; ++axis)
      felt_.force_n.push_back(newtons_[axis] * row.force_commanded[axis]);
    if ((row.flags & (schema::flag_force_limited | schema::flag_slew_limited)) != 0) ++felt_.limited_ticks;
  }

 private:
  FeltForces& felt_;
  std::vector<double> newtons_;
};

}  // namespace

double FeltForces::magnitude_n(std::size_t tick) const noexcept {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < axes; ++axis) squared += std::pow(force_n[tick * axes + axis], 2);
  return std::sqrt(squared);
}

double FeltForces::rms_n() const noexcept {
  double sum = 0.0;
  std::size_t in_contact = 0;
  for (std::size_t tick = 0; tick < ticks(); ++tick) {
    const double magnitude = magnitude_n(tick);
    if (magnitude <= no_force_n) continue;
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

FeltRenderer::FeltRenderer(const Protocol& protocol, const FeltOptions& options)
    : protocol_(&protocol),
      device_uri_(options.device_uri.empty() ? protocol.device_uri : options.device_uri) {
  if (device_uri_.empty() && !options.open_loop) device_uri_ = first_that_fits(protocol);
  if (options.open_loop || !device_uri_.starts_with("sim:")) device_uri_.clear();
  if (is_open_loop() && !protocol.motion) {
    throw std::invalid_argument(
        fmt::format("protocol '{}' has no [motion], along which forces could be rendered without a simulated "
                    "device; add one, or give --device sim:...",
                    protocol.name));
  }
  if (protocol.motion) seconds_ = protocol.motion->seconds.value_or(seconds_);
  if (options.seconds > 0.0) seconds_ = options.seconds;
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
  FeltForces felt;
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
            return rendering_of(law, device);
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
  FeltForces felt{.axes = law_axes.size(), .force_n = forces_along(*protocol_, law)};
  for (std::size_t i = 0; i < felt.force_n.size(); ++i)
    felt.force_n[i] *= 1.0 / fitting::felt_lever(law_axes[i % felt.axes].force_unit);
  return felt;
}

double difference_in_jnds(const Observer& observer, const FeltForces& first, const FeltForces& second) {
  if (first.axes != second.axes || first.force_n.size() != second.force_n.size())
    throw std::invalid_argument("forces that are compared have to be as long as each other");
  double sum = 0.0;
  std::size_t in_contact = 0;
  for (std::size_t tick = 0; tick < first.ticks(); ++tick) {
    const double middle = 0.5 * (first.magnitude_n(tick) + second.magnitude_n(tick));
    if (middle <= no_force_n) continue;
    double squared = 0.0;
    for (std::size_t axis = 0; axis < first.axes; ++axis)
      squared +=
          std::pow(first.force_n[tick * first.axes + axis] - second.force_n[tick * first.axes + axis], 2);
    sum += squared / std::pow(jnd_at(observer, middle), 2);
    ++in_contact;
  }
  return in_contact == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(in_contact));
}

}  // namespace kerf::bench

#include "session/device_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/drivers/device.h>

#include "chart/cost/tick_cost.h"
#include "laws/placement.h"
#include "protocol/samples.h"
#include "run/run.h"
#include "stability/device/in_hand.h"

namespace kerf::bench {
namespace {

constexpr double watched_s = 3.0;
constexpr double limited_share = 0.05;  ///< of the ticks that may hit a limit
constexpr double sweep_s = 1.0;         ///< of the path on which laws are timed
constexpr std::string_view grip = "firm";

struct NamedSample {
  std::string name;
  PlayedLaw played;
};

/// Every sample; the standard also at the ends of the scale.
std::vector<NamedSample> all_samples(const Protocol& protocol) {
  constexpr double as_it_is = std::numeric_limits<double>::quiet_NaN();
  std::vector<NamedSample> all;
  for (std::size_t sample = 0; sample < protocol.samples.size(); ++sample)
    all.push_back({protocol.samples[sample].name, played(protocol, sample, as_it_is)});
  if (!has_levels(protocol.design)) return all;
  std::vector<double> ends = protocol.scale.levels;
  if (protocol.design == Design::staircase) ends = {protocol.scale.staircase.start};
  const auto [least, most] = std::ranges::minmax_element(ends);
  for (const double level : {*least, *most}) {
    const std::size_t standard = protocol.scale.standard;
    all.push_back({fmt::format("{} at level {:g}", protocol.samples[standard].name, level),
                   played(protocol, standard, level)});
  }
  return all;
}

/// Every axis through the middle half of its range and back.
SampledMotion sweep(const drivers::DeviceInfo& device, double rate_hz) {
  const double period_s = 1.0 / rate_hz;
  SampledMotion path = ticks_at(rate_hz, static_cast<std::size_t>(sweep_s / period_s));
  for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(tick) * period_s / sweep_s;
    for (std::size_t axis = 0; axis < device.axes.size(); ++axis) {
      const double middle = 0.5 * (device.axes[axis].lower + device.axes[axis].upper);
      const double reach = 0.25 * (device.axes[axis].upper - device.axes[axis].lower);
      path.sample[tick].position[axis] = middle - reach * std::cos(phase);
      path.sample[tick].velocity[axis] = reach * 2.0 * std::numbers::pi / sweep_s * std::sin(phase);
    }
  }
  return path;
}

void require_in_time(const Protocol& protocol, const std::vector<NamedSample>& samples,
                     const drivers::DeviceInfo& device) {
  const double period_s = 1.0 / protocol.rate_hz;
  const SampledMotion path = sweep(device, protocol.rate_hz);
  std::vector<TimedLaw> timed;
  for (const NamedSample& one : samples) {
    const LawFile& law = one.played.law;
    timed.push_back({.rendering = {law.law, law.contact, axes_for(law, device)}, .path = &path});
  }
  std::vector<double> costs_ns;
  for (const TickCost& cost : tick_costs(timed, {.rounds = 5, .cold_ticks = 0}))
    costs_ns.push_back(cost.p999_ns);
  std::ranges::sort(costs_ns, std::greater());
  // A trial computes two laws: the two dearest ones have to fit.
  const double both_ns = costs_ns[0] + costs_ns[std::min<std::size_t>(1, costs_ns.size() - 1)];
  if (both_ns <= compute_share * 1e9 * period_s) return;
  throw std::invalid_argument(
      fmt::format("two laws together take up to {:.0f} us a tick in 99.9 % of the ticks, and half of the "
                  "period is {:.0f} us; "
                  "a blind trial computes both in every tick: take simpler laws or a lower rate",
                  1e-3 * both_ns, 1e6 * compute_share * period_s));
}

void require_rendered(const NamedSample& sample, const Protocol& protocol, const std::string& uri,
                      const std::atomic<bool>& stop) {
  const RunOptions options{
      .device_uri = uri,
      .seconds = watched_s,
      .rate_hz = protocol.rate_hz,
      .virtual_time = true,
      .rendering = [&](const drivers::DeviceInfo& on) { return rendering_of(sample.played, on); },
      .ramp_s = protocol.ramp_s,
  };
  const LoopReport report = run_on_device(options, stop).report;
  if (const auto faults = report.ticks_with(schema::flag_law_fault); faults > 0) {
    throw std::invalid_argument(
        fmt::format("sample '{}' fails its check on {}: the law gave no finite force in {} of {} ticks",
                    sample.name, uri, faults, report.ticks()));
  }
  for (const auto& [flag, what] :
       {std::pair{schema::flag_force_limited, "force"}, {schema::flag_slew_limited, "slew"}}) {
    const auto ticks = report.ticks_with(flag);
    if (static_cast<double>(ticks) <= limited_share * static_cast<double>(report.ticks())) continue;
    throw std::invalid_argument(
        fmt::format("sample '{}' fails its check on {}: its {} is cut to the limit of the device in {} of {} "
                    "ticks; take a "
                    "weaker law, or loudness = \"peak\" with a weaker first sample",
                    sample.name, uri, what, ticks, report.ticks()));
  }
}

/// How far the protocol's motion goes into a law; 0, which is not judged, where it says none.
double depth_in(const Protocol& protocol, const LawFile& law) {
  if (!protocol.motion || law.law.is_spatial()) return 0.0;
  return deepest(motion_along(protocol, law), 0, law.contact);
}

}  // namespace

std::vector<std::string> check_samples(const Protocol& protocol, const std::string& device_uri,
                                       const std::atomic<bool>& stop) {
  const drivers::DeviceInfo device = drivers::open_device(device_uri, {.stop = &stop})->info();
  const std::vector<NamedSample> samples = all_samples(protocol);
  for (const NamedSample& sample : samples) {
    try {
      (void)axes_for(sample.played.law, device);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(
          fmt::format("sample '{}' cannot be rendered on {}: {}", sample.name, device_uri, error.what()));
    }
  }
  require_in_time(protocol, samples, device);
  std::vector<std::string> remarks;
  for (const NamedSample& sample : samples) {
    if (device.simulated) require_rendered(sample, protocol, device_uri, stop);
    const StabilityVerdict verdict = stability_in_hand(
        sample.played.law, device, protocol.rate_hz, grip_named(grip), depth_in(protocol, sample.played.law));
    if (verdict.stable == Stable::no)
      remarks.push_back(fmt::format("sample '{}': {}", sample.name, verdict.why));
  }
  return remarks;
}

}  // namespace kerf::bench

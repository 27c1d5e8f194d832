#include "session/device_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/drivers/device.h>

#include "chart/cost/tick_cost.h"
#include "device_model/model_in_use.h"
#include "laws/placement.h"
#include "protocol/samples.h"
#include "run/run.h"
#include "stability/device/in_hand.h"

namespace kerf::bench {
namespace {

constexpr double watched_s = 3.0;
constexpr double sweep_s = 1.0;  ///< of the path on which laws are timed
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
  if (!has_levels(protocol.design) && protocol.scale.levels.empty()) return all;
  std::vector<double> ends = protocol.scale.levels;
  if (protocol.design == Design::staircase) {
    ends.clear();
    for (const auto& staircase : protocol.scale.staircases()) ends.push_back(staircase.start);
  }
  if (protocol.catches.every > 0) ends.push_back(protocol.catches.level);
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

/// The guide's coupling, by what is known of the device alone: nobody may hold it.
///
///     b > K T / 2 + B   [ColgateSchenkel1997]
///
/// with its friction b. Its force leaves the law half of what the device gives.
void require_led_softly(const Protocol& protocol, const drivers::DeviceInfo& device,
                        std::vector<std::string>& remarks) {
  if (!protocol.guide || !protocol.guide->felt) return;
  const FeltGuide& felt = *protocol.guide->felt;
  const drivers::AxisInfo& axis = device.axes[axes_for(protocol.samples.front().law, device).front()];
  if (felt.limit > 0.5 * axis.force_limit)
    throw std::invalid_argument(
        fmt::format("the [guide] is felt with up to {:g} {}, and {} gives {:g} {} on '{}'; expected at most "
                    "half of that, so that the law has the other: lower 'limit'",
                    felt.limit, axis.force_unit, device.model, axis.force_limit, axis.force_unit, axis.name));
  if (!axis.mechanics) {
    remarks.push_back(
        fmt::format("nobody knows the friction of '{}', so that the [guide]'s stiffness was not checked: try "
                    "it with a light hand",
                    axis.name));
    return;
  }
  // Of the travel at the lever, as friction is given; where there is none, of the joint.
  const double stiffest =
      (axis.mechanics->viscous_n_s_per_m - felt.damping / axis.lever) * 2.0 * protocol.rate_hz * axis.lever;
  if (felt.stiffness <= stiffest) return;
  throw std::invalid_argument(fmt::format(
      "the [guide] is felt with {:.4g} {}/{} and a damping of {:.4g} {}·s/{}, and {} renders such a coupling "
      "passively on '{}' up to {:.4g} {}/{} at {:g} Hz; lower 'stiffness'{}",
      felt.stiffness, axis.force_unit, axis.position_unit, felt.damping, axis.force_unit, axis.position_unit,
      device.model, axis.name, std::max(0.0, stiffest), axis.force_unit, axis.position_unit, protocol.rate_hz,
      felt.damping > 0.0 ? " or 'damping'" : ""));
}

/// In a sequence each sample has its place in the target's cycle; where that is not the same for all of them
/// they are felt along other ways.
void tell_uneven_ways(const Protocol& protocol, std::vector<std::string>& remarks) {
  if (!protocol.guide || !protocol.guide->leads(false) || !protocol.guide->has_target() ||
      protocol.presentation != Presentation::sequence || slots_of(protocol) < 2)
    return;
  const double each_s = protocol.interval_s + protocol.gap_s;
  const double cycles = each_s / protocol.guide->cycle_s();
  if (std::abs(cycles - std::round(cycles)) < 0.01) return;
  remarks.push_back(
      fmt::format("the samples of a trial are felt along other parts of the [guide]'s way: 'interval' and "
                  "'gap' are {:.4g} s together, and a cycle is {:.4g} s; expected a multiple of it",
                  each_s, protocol.guide->cycle_s()));
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
    if (static_cast<double>(ticks) <= protocol.limited_share * static_cast<double>(report.ticks())) continue;
    throw std::invalid_argument(
        fmt::format("sample '{}' fails its check on {}: its {} is cut to the limit of the device in {} of {} "
                    "ticks, at most {:g} % are allowed (limited_share); take a weaker law, or loudness = "
                    "\"felt-rms\" with a weaker first sample",
                    sample.name, uri, what, ticks, report.ticks(), 100.0 * protocol.limited_share));
  }
}

/// How far the protocol's motion goes into a law; 0, which is not judged, where it says none.
double depth_in(const Protocol& protocol, const LawFile& law) {
  if (!protocol.motion || law.law.is_spatial()) return 0.0;
  return deepest(motion_along(protocol, law), 0, law.contact);
}

}  // namespace

std::vector<std::string> check_samples(const Protocol& protocol, const std::string& device_uri,
                                       const std::atomic<bool>& stop, SamplesTold told,
                                       const std::string& device_model) {
  drivers::DeviceInfo device = drivers::open_device(device_uri, {.stop = &stop})->info();
  std::vector<std::string> remarks;
  const auto model = take_model(device, {.file = device_model,
                                         .rate_hz = protocol.rate_hz,
                                         .now = {},
                                         .warn = [&](std::string_view line) { remarks.emplace_back(line); }});
  if (model) {
    for (std::string& line : lines_of(*model)) remarks.push_back(std::move(line));
  }
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
  require_led_softly(protocol, device, remarks);
  tell_uneven_ways(protocol, remarks);
  for (const NamedSample& sample : samples) {
    if (device.simulated) require_rendered(sample, protocol, device_uri, stop);
    const StabilityVerdict verdict = stability_in_hand(
        sample.played.law, device, protocol.rate_hz, grip_named(grip), depth_in(protocol, sample.played.law));
    if (verdict.stable == Stable::no)
      remarks.push_back(fmt::format("sample '{}': {}", sample.name, verdict.why));
  }
  for (std::string& remark : felt_remarks(protocol, device_uri, told)) remarks.push_back(std::move(remark));
  return remarks;
}

}  // namespace kerf::bench

#include "choose/loop_checks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "laws/placement.h"
#include "report/charts.h"
#include "run/check.h"
#include "run/run.h"

namespace kerf::bench {
namespace {

constexpr double watched_s = 8.0;        ///< how long a free hand is looked at
constexpr double virtual_s = 6.0;        ///< of the shorter run in virtual time
constexpr double limited_share = 1e-3;   ///< of the ticks that may hit a limit
constexpr double given_within_j = 1e-3;  ///< energy that quantised positions may feign
constexpr double energy_growth = 1.25;   ///< of what is given, from the shorter run to one twice as long
constexpr double met_share = 0.5;        ///< of the recorded depth, that a hand has to reach
constexpr int attempts = 3;

struct Travel {
  double lower = 0.0;
  double upper = 0.0;
};

/// Where the hand takes an axis of a simulated device if nothing is in its way.
Travel travel_of_hand(const std::string& uri, std::size_t axis) {
  const auto device = drivers::open_device(uri);
  constexpr double period_s = 1e-3;
  drivers::Sample sample;
  Travel travel{.lower = std::numeric_limits<double>::infinity(),
                .upper = -std::numeric_limits<double>::infinity()};
  for (int tick = 0; tick < static_cast<int>(watched_s / period_s); ++tick) {
    if (device->read(period_s * tick, sample) != drivers::Status::ok) continue;
    travel.lower = std::min(travel.lower, sample.position[axis]);
    travel.upper = std::max(travel.upper, sample.position[axis]);
  }
  return travel;
}

double deepest(const schema::Recording& recording, std::size_t axis, const models::Contact& contact) {
  double most = 0.0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const double position = recording.position[row * recording.dimensions() + axis];
    if (std::isfinite(position)) most = std::max(most, contact.motion(position, 0.0).penetration);
  }
  return most;
}

/// Nothing where the hand meets the law well enough as it stands.
std::optional<models::Contact> better_contact(const Travel& travel, double depth,
                                              const models::Contact& contact) {
  const double far_end = contact.position + contact.direction * depth;
  const double overlap = std::min(travel.upper, std::max(contact.position, far_end)) -
                         std::max(travel.lower, std::min(contact.position, far_end));
  const double reach = std::min(depth, travel.upper - travel.lower);
  if (overlap >= met_share * reach) return std::nullopt;
  const double end = contact.direction > 0.0 ? travel.upper : travel.lower;
  return models::Contact{.position = end - contact.direction * reach, .direction = contact.direction};
}

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text;
}

}  // namespace

std::string device_for(const schema::Recording& recording, std::size_t axis) {
  const std::string& uri = recording.header.device_uri;
  if (uri.starts_with("sim:")) return uri;
  const schema::Axis& wanted = recording.axes.at(axis);
  for (const drivers::DeviceInfo& device : drivers::list_devices()) {
    const bool fits = std::ranges::any_of(device.axes, [&](const drivers::AxisInfo& one) {
      return one.position_unit == wanted.position_unit && one.force_unit == wanted.force_unit;
    });
    if (fits) return device.uri;
  }
  throw std::invalid_argument(
      fmt::format("no simulated device has an axis with {} over {}; name one with --device, or leave out the "
                  "checks in closed loop with --no-loop",
                  wanted.force_unit, wanted.position_unit));
}

LoopChecks::LoopChecks(LoopCheckOptions options, const std::atomic<bool>& stop)
    : options_(std::move(options)),
      stop_(stop),
      device_(drivers::open_device(options_.device_uri, {.stop = &stop})->info()),
      model_(take_model(
          device_, {.file = options_.device_model, .rate_hz = options_.rate_hz, .now = {}, .warn = {}})) {}

void LoopChecks::place(const schema::Recording& recording, std::size_t axis, const models::Contact& contact) {
  const schema::Axis& about = recording.axes.at(axis);
  const LawFile any{.law = models::Law::make("kelvin", std::vector{1.0, 1.0, 1.0}),
                    .contact = contact,
                    .axis = about.name,
                    .position_unit = about.position_unit,
                    .force_unit = about.force_unit};
  const std::size_t on = axis_for(any, device_);
  deepest_ = deepest(recording, axis, contact);
  if (!device_.simulated) return;
  const Travel travel = travel_of_hand(options_.device_uri, on);
  placed_at_ = better_contact(travel, deepest_, contact);
  if (!placed_at_) return;
  const DrawnUnit unit = drawn_position(about);
  placed_in_words_ = fmt::format(
      "for the closed loop the laws begin at {:.3g} {} of {}, where its hand, which moves from {:.3g} to "
      "{:.3g} "
      "{}, meets them",
      unit.factor * placed_at_->position, unit.unit, device_.axes[on].name, unit.factor * travel.lower,
      unit.factor * travel.upper, unit.unit);
}

LawFile LoopChecks::placed(LawFile law) const {
  if (placed_at_) law.contact = *placed_at_;
  return law;
}

Deadline LoopChecks::deadline(const LawFile& law) const {
  Deadline deadline;
  for (int attempt = 0; attempt < attempts && !stop_; ++attempt) {
    const RunResult result = run_on_device({.device_uri = options_.device_uri,
                                            .seconds = options_.seconds,
                                            .rate_hz = options_.rate_hz,
                                            .law = placed(law)},
                                           stop_);
    const Verdict verdict = judge(result);
    const double p999_ns = result.report.compute_cpu.percentile_ns(0.999);
    deadline = {.held = verdict.passed,
                .machine_late = verdict.causes == std::set{Cause::machine},
                .p999_us = 1e-3 * p999_ns,
                .missed = result.report.missed(),
                .ticks = result.report.ticks(),
                .why = verdict.passed ? "" : joined(verdict.reasons)};
    if (p999_ns > options_.margin * 1e9 * result.period_s && deadline.held) {
      deadline.held = false;
      deadline.why = fmt::format("99.9 % of its ticks take up to {:.1f} us, and {:.0f} us were asked for",
                                 deadline.p999_us, options_.margin * 1e6 * result.period_s);
    }
    if (!deadline.machine_late) break;
  }
  return deadline;
}

StabilityVerdict LoopChecks::judged(StabilityVerdict in_hand, const LawFile& law,
                                    bool passivity_control) const {
  if (!in_hand.why.empty()) in_hand.why = fmt::format("on {}, {}", options_.device_uri, in_hand.why);
  if (in_hand.stable == Stable::no || !device_.simulated) return in_hand;
  if (auto why = misrendered(law, passivity_control)) return not_stable(*std::move(why));
  return in_hand;
}

StabilityVerdict LoopChecks::stability(const LawFile& law) const {
  return judged(stability_in_hand(law, device_, options_.rate_hz, grip_named(options_.grip), deepest_), law,
                false);
}

ControlledInHand LoopChecks::controlled(const LawFile& law) const {
  ControlledInHand found =
      controlled_in_hand(law, device_, options_.rate_hz, grip_named(options_.grip), deepest_);
  found.verdict = judged(std::move(found.verdict), law, true);
  return found;
}

std::optional<std::string> LoopChecks::misrendered(const LawFile& law, bool passivity_control) const {
  const auto run = [&](double seconds) {
    return run_on_device({.device_uri = options_.device_uri,
                          .seconds = seconds,
                          .rate_hz = options_.rate_hz,
                          .virtual_time = true,
                          .law = placed(law),
                          .passivity_control = passivity_control,
                          .device_model = passivity_control ? options_.device_model : std::string()},
                         stop_)
        .report;
  };
  const LoopReport half = run(virtual_s);
  const LoopReport whole = run(2.0 * virtual_s);
  for (const auto& [flag, what] : {std::pair{schema::flag_force_limited, "the force"},
                                   std::pair{schema::flag_slew_limited, "the slew"}}) {
    const std::uint64_t ticks = whole.ticks_with(flag);
    if (static_cast<double>(ticks) <= limited_share * static_cast<double>(whole.ticks())) continue;
    return fmt::format("on {} {} is cut to the limit of the device in {} of {} ticks", options_.device_uri,
                       what, ticks, whole.ticks());
  }
  const double given_j = -whole.least_energy_j;
  if (given_j <= given_within_j - energy_growth * half.least_energy_j) return std::nullopt;
  return fmt::format(
      "on {} it gives energy to the hand again and again: {:.2g} J in {:.0f} s, {:.2g} J in {:.0f} s",
      options_.device_uri, std::max(0.0, -half.least_energy_j), virtual_s, given_j, 2.0 * virtual_s);
}

}  // namespace kerf::bench

#include "kerf/drivers/faulty_device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>

#include <time.h>

#include "kerf/drivers/velocity_filter.h"

namespace kerf::drivers {
namespace {

struct KindInfo {
  Fault::Kind kind;
  std::string_view name;
  std::string_view unit;  ///< of the size; empty: it has none
  bool needs_size;
};
constexpr std::array kinds{
    KindInfo{Fault::Kind::unplug, "unplug", "", false}, KindInfo{Fault::Kind::stall, "stall", "s", true},
    KindInfo{Fault::Kind::late, "late", "s", true},     KindInfo{Fault::Kind::nan, "nan", "s", false},
    KindInfo{Fault::Kind::jump, "jump", "m", true},     KindInfo{Fault::Kind::flip, "flip", "m", true}};

[[noreturn]] void refuse(std::string_view fault) {
  throw DeviceError("fault '" + std::string(fault) +
                    "': expected KIND@SECONDS or KIND@SECONDS:SIZE, such as unplug@2.5, stall@1.0:50ms, "
                    "late@5.0:3ms, nan@3.0, nan@3.0:20ms, jump@4.0:20mm or flip@4.0:20mm");
}

/// A number with a unit, which may stand in thousandths ("50ms"), in SI; NaN for anything else.
double quantity(std::string_view text, std::string_view unit) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view suffix = text.substr(static_cast<std::size_t>(end - text.data()));
  const bool thousandths = !unit.empty() && suffix.starts_with('m') && suffix.substr(1) == unit;
  if (error != std::errc{} || !(thousandths || suffix == unit)) return std::nan("");
  return thousandths ? 1e-3 * value : value;
}

Fault parse_fault(std::string_view text) {
  const auto at = std::min(text.find('@'), text.size());
  const auto found = std::ranges::find(kinds, text.substr(0, at), &KindInfo::name);
  if (found == kinds.end() || at == text.size()) refuse(text);
  const std::string_view rest = text.substr(at + 1);
  const auto colon = std::min(rest.find(':'), rest.size());
  const bool has_size = colon < rest.size();
  if (has_size ? found->unit.empty() : found->needs_size) refuse(text);
  const std::string_view moment = rest.substr(0, colon);
  const Fault fault{.kind = found->kind,
                    .at_s = quantity(moment, moment.ends_with('s') ? "s" : ""),
                    .size = has_size ? quantity(rest.substr(colon + 1), found->unit) : 0.0};
  const bool backwards = found->unit != "m" && fault.size < 0.0;
  if (!(fault.at_s >= 0.0 && fault.at_s <= 1e6) || !(std::abs(fault.size) <= 100.0) || backwards)
    refuse(text);
  return fault;
}

void sleep_for(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  timespec rest{.tv_sec = whole, .tv_nsec = static_cast<long>(1e9 * (seconds - static_cast<double>(whole)))};
  while (clock_nanosleep(CLOCK_MONOTONIC, 0, &rest, &rest) == EINTR) {
  }
}

}  // namespace

std::vector<Fault> parse_faults(std::string_view text) {
  std::vector<Fault> faults;
  while (true) {
    const auto comma = std::min(text.find(','), text.size());
    faults.push_back(parse_fault(text.substr(0, comma)));
    if (comma == text.size()) return faults;
    text.remove_prefix(comma + 1);
  }
}

FaultyDevice::FaultyDevice(std::unique_ptr<Device> device, const std::vector<Fault>& faults,
                           std::function<void(double)> pass_time)
    : device_(std::move(device)), pass_time_(pass_time ? std::move(pass_time) : sleep_for) {
  for (const Fault& fault : faults) faults_.push_back({.fault = fault});
}

double FaultyDevice::delay(Fault::Kind kind) noexcept {
  double seconds = 0.0;
  for (auto& [fault, done] : faults_) {
    if (fault.kind != kind || done || now_s_ < fault.at_s) continue;
    seconds += fault.size;
    done = true;
  }
  return seconds;
}

void FaultyDevice::spoil(Sample& sample) noexcept {
  for (auto& [fault, done] : faults_) {
    const double since_s = now_s_ - fault.at_s;
    if (since_s < 0.0) continue;
    if (fault.kind == Fault::Kind::jump) {
      const double offset = fault.size / device_->info().axes[0].lever;
      sample.position[0] += offset;
      constexpr double corner_rad_s = VelocityFilter::corner_rad_s;  // of the simulated encoders' velocity
      sample.velocity[0] += offset * corner_rad_s * std::exp(-corner_rad_s * since_s);
    } else if (fault.kind == Fault::Kind::flip && !done) {
      sample.position[0] += fault.size / device_->info().axes[0].lever;
      done = true;
    } else if (fault.kind == Fault::Kind::nan && (!done || since_s < fault.size)) {
      sample.position[0] = std::numeric_limits<double>::quiet_NaN();
      done = true;
    }
  }
}

Status FaultyDevice::read(double now_s, Sample& sample) noexcept {
  now_s_ = now_s;
  for (const auto& pending : faults_) {
    unplugged_ |= pending.fault.kind == Fault::Kind::unplug && now_s >= pending.fault.at_s;
  }
  if (unplugged_) return Status::lost;
  if (const double stalled_s = delay(Fault::Kind::stall); stalled_s > 0.0) {
    pass_time_(stalled_s);
    now_s_ += stalled_s;
  }
  const Status status = device_->read(now_s_, sample);
  spoil(sample);
  return status;
}

Status FaultyDevice::write(const Axes& force) noexcept {
  if (unplugged_) return Status::lost;
  if (const double late_s = delay(Fault::Kind::late); late_s > 0.0) pass_time_(late_s);
  return device_->write(force);
}

}  // namespace kerf::drivers

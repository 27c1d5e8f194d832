#include "kerf/drivers/hosted_device.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <time.h>

#include "age_limits.h"
#include "hosted/device_host.h"
#include "hosted/facts.h"
#include "kerf/drivers/device_notes.h"
#include "kerf/drivers/usb/io_thread.h"

namespace kerf::drivers {
namespace {

using hosted::Reading;

bool is_finite(const double* values, std::size_t count) noexcept {
  return std::all_of(values, values + count, [](double one) { return std::isfinite(one); });
}

/// Three periods of a device that is slower than the usual.
std::int64_t oldest_of(double rate_hz) noexcept {
  const double three_periods_s = rate_hz > 0.0 ? 3.0 / rate_hz : 0.0;
  return std::max<std::int64_t>(max_reading_age_ns, std::llround(1e9 * std::min(three_periods_s, 0.5)));
}

}  // namespace

HostedDevice::HostedDevice(std::string_view uri, std::unique_ptr<hosted::DeviceHost> host,
                           const std::string& identity)
    : host_(std::move(host)),
      info_(hosted::info_of(host_->page().facts, host_->page().has_write.load() != 0, uri)),
      has_write_(host_->page().has_write.load() != 0),
      tells_velocity_((host_->page().facts.flags & KERF_TELLS_VELOCITY) != 0),
      writes_any_time_((host_->page().facts.flags & KERF_WRITES_ANY_TIME) != 0),
      oldest_ns_(oldest_of(host_->page().facts.rate_hz)),
      own_channels_(info_.channels.size()),
      opened_ns_(usb::now_ns()),
      velocity_(info_.axes.size()) {
  info_.channels.push_back({.name = "report_age", .unit = "s"});
  info_.configuration = identity + info_.configuration;
  for (const AxisInfo& axis : info_.axes) {
    if (axis.acceleration_limit > 0.0 || !has_write_) continue;
    note_device(
        fmt::format("{}: it tells no acceleration limit of '{}', so that a reading with a turned bit is "
                    "taken for a motion",
                    uri, axis.name));
  }
  wait_for_first();
}

HostedDevice::~HostedDevice() = default;

void HostedDevice::wait_for_first() {
  const std::int64_t until_ns = usb::now_ns() + max_silence_ns;
  constexpr timespec pause{.tv_sec = 0, .tv_nsec = 1'000'000};
  while (host_->page().readings.count() == 0) {
    const bool over = usb::now_ns() > until_ns;
    const bool is_lost = host_->page().lost.load() != 0;
    if (is_lost) host_->wait_for_reason();
    if (const std::string why = over || is_lost ? host_->trouble() : std::string(); over || !why.empty()) {
      throw DeviceError(fmt::format(
          "{}: it was opened, and no reading has come: {}", info_.uri,
          why.empty() ? std::string("its read() finds none; look at cable, port and speed") : why));
    }
    nanosleep(&pause, nullptr);
  }
  take_newest();
}

void HostedDevice::take_newest() noexcept {
  const auto& readings = host_->page().readings;
  const std::uint64_t newest = readings.count();
  if (newest == seen_) return;
  Reading reading;
  if (!readings.get(newest, reading)) return;  // the next tick has it, or the one after
  seen_ = newest;
  const kerf_device_reading_v1& told = reading.told;
  const std::size_t axes = info_.axes.size();
  arrived_ns_ = reading.arrived_ns;
  taken_ns_ = told.taken_ns;
  is_doubted_ = (told.flags & KERF_DOUBTED) != 0 || !is_finite(told.position, axes) ||
                (tells_velocity_ && !is_finite(told.velocity, axes));
  if (!is_doubted_) {
    std::copy_n(told.position, axes, last_.position.begin());
    if (tells_velocity_) {
      std::copy_n(told.velocity, axes, last_.velocity.begin());
    } else {
      velocity_.update(last_.position, taken_ns_, info_);
      for (std::size_t axis = 0; axis < axes; ++axis) last_.velocity[axis] = velocity_.velocity(axis);
    }
  }
  const bool has_force = info_.measures_force && (told.flags & (KERF_NO_FORCE | KERF_OVERLOADED)) == 0;
  for (std::size_t axis = 0; axis < axes; ++axis)
    last_.force_measured[axis] = has_force ? told.force[axis] : std::nan("");
  std::copy_n(told.channels, own_channels_, last_.channels.begin());
}

bool HostedDevice::lost(std::int64_t now_ns) const noexcept {
  const auto& page = host_->page();
  return page.lost.load(std::memory_order_acquire) != 0 ||
         page.host_ended.load(std::memory_order_acquire) != 0 || now_ns - arrived_ns_ > max_silence_ns;
}

Status HostedDevice::read(double, Sample& sample) noexcept {
  take_newest();
  const std::int64_t now = usb::now_ns();
  last_.age_s = 1e-9 * static_cast<double>(now - taken_ns_);
  last_.channels[own_channels_] = last_.age_s;
  sample = last_;
  if (lost(now)) return Status::lost;
  return is_doubted_ || now - taken_ns_ > oldest_ns_ ? Status::fault : Status::ok;
}

Status HostedDevice::write(const Axes& force) noexcept {
  const std::int64_t now = usb::now_ns();
  const bool finite = is_finite(force.data(), info_.axes.size());
  if (!has_write_) return lost(now) ? Status::lost : finite ? Status::ok : Status::fault;
  hosted::Command command{.at_ns = now};
  for (std::size_t axis = 0; finite && axis < info_.axes.size(); ++axis) {
    const double limit = info_.axes[axis].force_limit;
    command.force[axis] = std::clamp(force[axis], -limit, limit);
  }
  host_->page().commands.put(command);
  if (writes_any_time_) host_->wake();
  if (lost(now)) return Status::lost;
  return finite && host_->page().unguarded.load(std::memory_order_relaxed) == 0 ? Status::ok : Status::fault;
}

void HostedDevice::release(double) noexcept {
  host_->page().let_go_ns.store(usb::now_ns(), std::memory_order_release);
  if (writes_any_time_) host_->wake();
}

std::vector<Figure> HostedDevice::figures() const {
  const auto& page = host_->page();
  const auto reports = static_cast<double>(page.readings.count());
  const double seconds = 1e-9 * static_cast<double>(usb::now_ns() - opened_ns_);
  return {{"report_rate", seconds > 0.0 ? reports / seconds : 0.0, "Hz"},
          {"reports", reports, "1"},
          {"reports_missing", static_cast<double>(page.missing.load()), "1"},
          {"reports_repeated", static_cast<double>(page.repeated.load()), "1"},
          {"forces_not_taken", static_cast<double>(page.not_taken.load()), "1"},
          {"let_go_instead", static_cast<double>(page.let_go_instead.load()), "1"}};
}

std::string HostedDevice::trouble() const { return host_->trouble(); }

}  // namespace kerf::drivers

#include "kerf/drivers/sensed_device.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kerf/drivers/force_calibration.h"

namespace kerf::drivers {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::string names_of(const std::vector<AxisInfo>& axes) {
  std::string names;
  for (const AxisInfo& axis : axes) names += (names.empty() ? "" : ", ") + axis.name;
  return names;
}

/// What a component is multiplied with to be the force of an axis.
double factor_of(const ForceMount& mount, const std::string& component_unit, const AxisInfo& axis) {
  const bool same = component_unit == axis.force_unit;
  if (same == (mount.lever_m > 0.0)) {
    throw DeviceError(fmt::format(
        "force sensor: [axes] '{}' takes {} [{}] for a force in {}: {}", axis.name,
        wrench_names.at(mount.component), component_unit, axis.force_unit,
        same ? "leave out lever_m" : "give the lever between them, { component = ..., lever_m = 0.04 }"));
  }
  if (same) return mount.sign;
  return axis.force_unit == "N" ? mount.sign / mount.lever_m : mount.sign * mount.lever_m;
}

}  // namespace

SensedDevice::SensedDevice(std::unique_ptr<Device> device, std::unique_ptr<Device> sensor)
    : device_(std::move(device)),
      sensor_(std::move(sensor)),
      info_(device_->info()),
      own_channels_(info_.channels.size()) {
  const DeviceInfo& sensing = sensor_->info();
  if (!sensing.measures_force)
    throw DeviceError(fmt::format("{} measures no force: it is no --sensor", sensing.uri));
  find_sources();
  info_.channels.insert(info_.channels.end(), sensing.channels.begin(), sensing.channels.end());
  if (info_.channels.size() > max_channels) {
    throw DeviceError(
        fmt::format("{} and {} have {} channels together, {} can be recorded; leave out the device's",
                    info_.uri, sensing.uri, info_.channels.size(), max_channels));
  }
  info_.measures_force = true;
  info_.configuration += fmt::format("\n[sensor]\nuri = \"{}\"\nmodel = \"{}\"\n{}", sensing.uri,
                                     sensing.model, sensing.configuration);
}

void SensedDevice::find_sources() {
  const DeviceInfo& sensing = sensor_->info();
  bool any = false;
  for (std::size_t at = 0; at < info_.axes.size(); ++at) {
    const AxisInfo& axis = info_.axes[at];
    const auto mount = std::ranges::find(sensing.mounts, axis.name, &ForceMount::axis);
    const auto same = std::ranges::find(sensing.axes, axis.name, &AxisInfo::name);
    if (mount != sensing.mounts.end()) {
      const AxisInfo& component = sensing.axes.at(mount->component);
      sources_[at] = {.component = mount->component, .factor = factor_of(*mount, component.force_unit, axis)};
    } else if (same != sensing.axes.end() && same->force_unit == axis.force_unit) {
      sources_[at] = {.component = static_cast<std::size_t>(same - sensing.axes.begin()), .factor = 1.0};
    }
    any |= sources_[at].factor != 0.0;
  }
  if (any) return;
  throw DeviceError(
      fmt::format("{} has no axis that {} could measure ({} and {}); say in [axes] of the sensor's "
                  "calibration which component acts "
                  "on which axis, for example {} = \"fx\"",
                  info_.uri, sensing.uri, names_of(info_.axes), names_of(sensing.axes),
                  info_.axes.empty() ? "x" : info_.axes.front().name));
}

Status SensedDevice::read(double now_s, Sample& sample) noexcept {
  const Status status = device_->read(now_s, sample);
  const Status sensed = sensor_->read(now_s, sensed_);
  for (std::size_t at = 0; at < info_.axes.size(); ++at) {
    const Source& source = sources_[at];
    const bool has = sensed == Status::ok && source.factor != 0.0;
    sample.force_measured[at] = has ? source.factor * sensed_.force_measured[source.component] : nothing;
  }
  for (std::size_t channel = own_channels_; channel < info_.channels.size(); ++channel) {
    sample.channels[channel] = sensed_.channels[channel - own_channels_];
  }
  sample.sensor_fault = sensed == Status::fault;
  return sensed == Status::lost ? Status::lost : status;
}

std::vector<Figure> SensedDevice::figures() const {
  std::vector<Figure> all = device_->figures();
  for (Figure& figure : sensor_->figures()) all.push_back(std::move(figure));
  return all;
}

std::string SensedDevice::trouble() const {
  const std::string own = device_->trouble();
  return own.empty() ? sensor_->trouble() : own;
}

std::unique_ptr<Device> open_device(std::string_view uri, std::string_view sensor_uri,
                                    Surroundings surroundings) {
  const bool alone = uri == "none";
  if (alone && sensor_uri.empty())
    throw DeviceError(
        "--device none: then what? It is for a force sensor that is recorded alone, by --sensor");
  if (sensor_uri.empty()) return open_device(uri, std::move(surroundings));
  Surroundings around_sensor;
  around_sensor.pass_time = surroundings.pass_time;
  around_sensor.stop = surroundings.stop;
  auto sensor = open_device(sensor_uri, std::move(around_sensor));
  if (alone && !sensor->info().measures_force)
    throw DeviceError(fmt::format("{} measures no force: it is no --sensor", sensor->info().uri));
  if (alone) return sensor;
  return std::make_unique<SensedDevice>(open_device(uri, std::move(surroundings)), std::move(sensor));
}

}  // namespace kerf::drivers

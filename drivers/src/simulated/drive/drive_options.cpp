#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kerf/drivers/simulated_drive.h"

namespace kerf::drivers {
namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

/// A light handle on a good capstan, as of the field's small devices.
AxisModel usual_axis(std::size_t at) {
  AxisModel model;
  model.name = axis_names[at];
  model.limits = {
      .lower = -0.1, .upper = 0.1, .force = 10.0, .slew = 5000.0, .speed = 5.0, .acceleration = 2000.0};
  model.mass = Estimate::exactly(0.08);
  model.viscous = Estimate::exactly(0.2);
  model.coulomb_up = Estimate::exactly(0.1);
  model.coulomb_down = Estimate::exactly(0.1);
  model.encoder_step = Estimate::exactly(20e-6);
  model.delay = Estimate::exactly(0.0);
  return model;
}

/// Options of several axes: what is given for one holds for all.
class AxisOptions {
 public:
  AxisOptions(UriOptions& given, std::size_t count) : given_(given), count_(count) {}

  /// Puts what is given into a number of each axis; what is not given leaves it.
  template <typename Put>
  void each(const std::string& name, std::string_view unit, double lower, double upper, Put put) {
    const auto values = given_.numbers(name, {unit, 0.0, lower, upper}, count_);
    for (std::size_t at = 0; at < values.size(); ++at) put(at, values[at]);
  }
  void known(const std::string& name, std::string_view unit, double lower, double upper,
             std::vector<SimulatedDrive::Axis>& axes, Known AxisModel::*member) {
    each(name, unit, lower, upper,
         [&](std::size_t at, double value) { axes[at].model.*member = Estimate::exactly(value); });
  }
  void plain(const std::string& name, std::string_view unit, double lower, double upper,
             std::vector<SimulatedDrive::Axis>& axes, double SimulatedDrive::Axis::*member) {
    each(name, unit, lower, upper, [&](std::size_t at, double value) { axes[at].*member = value; });
  }

 private:
  UriOptions& given_;
  std::size_t count_;
};

std::vector<SimulatedDrive::Axis> axes_to_begin_with(UriOptions& given, SimulatedDrive::Options& options) {
  const auto file = given.file("model");
  const auto count = static_cast<std::size_t>(given.count("axes", 0));
  if (count > axis_names.size())
    throw DeviceError(
        fmt::format("device 'sim:axis': option 'axes' is {}, expected 1 to {}", count, axis_names.size()));
  std::vector<SimulatedDrive::Axis> axes;
  if (!file) {
    for (std::size_t at = 0; at < std::max<std::size_t>(1, count); ++at)
      axes.push_back({.model = usual_axis(at), .hand = usual_grip});
    return axes;
  }
  if (count != 0)
    throw DeviceError("device 'sim:axis': option 'axes' does not go with 'model', whose file has its axes");
  options.model_file = *file;
  for (AxisModel& model : read_device_model(*file).axes) {
    const auto value = [](const Known& known, double otherwise) { return known ? known->value : otherwise; };
    const HandImpedance hand{.mass_kg = value(model.hand_mass, usual_grip.mass_kg),
                             .damping_n_s_per_m = value(model.hand_damping, usual_grip.damping_n_s_per_m),
                             .stiffness_n_per_m = value(model.hand_stiffness, usual_grip.stiffness_n_per_m)};
    axes.push_back({.model = std::move(model), .hand = hand});
  }
  return axes;
}

double sign_of(UriOptions& given, const std::string& name) {
  const double sign = given.number(name, {"1", 1.0, -1.0, 1.0});
  if (std::abs(sign) != 1.0)
    throw DeviceError(fmt::format("device 'sim:axis': option '{}' is {}, expected 1 or -1", name, sign));
  return sign;
}

void read_delays(UriOptions& given, std::vector<SimulatedDrive::Axis>& axes) {
  constexpr double longest_s = 0.1;
  const auto text = given.text("delay");
  if (!text) return;
  const bool in_ticks = text->find("ticks") != std::string::npos;
  const auto values = given.numbers("delay",
                                    in_ticks ? UriOptions::Quantity{"ticks", 0.0, 0.0, 32.0}
                                             : UriOptions::Quantity{"s", 0.0, 0.0, longest_s},
                                    axes.size());
  for (std::size_t at = 0; at < axes.size(); ++at) {
    axes[at].delay_ticks = in_ticks ? values[at] : 0.0;
    axes[at].model.delay = Estimate::exactly(in_ticks ? 0.0 : values[at]);
  }
}

void read_model(UriOptions& given, std::vector<SimulatedDrive::Axis>& axes) {
  AxisOptions all(given, axes.size());
  constexpr double any = 1e6;
  all.known("mass", "kg", 1e-6, 1000.0, axes, &AxisModel::mass);
  all.known("viscous", "Ns/m", 0.0, 1000.0, axes, &AxisModel::viscous);
  all.each("coulomb", "N", 0.0, 1000.0, [&](std::size_t at, double value) {
    axes[at].model.coulomb_up = axes[at].model.coulomb_down = Estimate::exactly(value);
  });
  all.known("coulomb_down", "N", 0.0, 1000.0, axes, &AxisModel::coulomb_down);
  all.each("gravity", "N", -1000.0, 1000.0, [&](std::size_t at, double value) {
    axes[at].model.gravity = Estimate::exactly(value);
    axes[at].model.gravity_table.reset();
  });
  read_delays(given, axes);
  all.known("jitter", "s", 0.0, 0.05, axes, &AxisModel::delay_jitter);
  all.known("step", "m", 0.0, 0.1, axes, &AxisModel::encoder_step);
  all.each("corner", "Hz", 0.0, 1e5, [&](std::size_t at, double value) {
    axes[at].model.velocity_corner = Estimate::exactly(2.0 * std::numbers::pi * value);
  });
  all.known("motor_constant", "1", 0.0, 100.0, axes, &AxisModel::motor_constant);
  all.known("saturation", "N", 0.0, any, axes, &AxisModel::saturation);
  all.each("range", "m", 1e-4, 100.0, [&](std::size_t at, double value) {
    axes[at].model.limits.lower = -value;
    axes[at].model.limits.upper = value;
  });
  all.each("limit", "N", 0.0, any,
           [&](std::size_t at, double value) { axes[at].model.limits.force = value; });
  all.each("slew", "N/s", 0.0, 1e9,
           [&](std::size_t at, double value) { axes[at].model.limits.slew = value; });
}

void read_hand(UriOptions& given, std::vector<SimulatedDrive::Axis>& axes) {
  AxisOptions all(given, axes.size());
  all.each("hand_mass", "kg", 0.0, 5.0, [&](std::size_t at, double value) { axes[at].hand.mass_kg = value; });
  all.each("hand_damping", "Ns/m", 0.0, 500.0,
           [&](std::size_t at, double value) { axes[at].hand.damping_n_s_per_m = value; });
  all.each("grip", "N/m", 0.0, 5000.0,
           [&](std::size_t at, double value) { axes[at].hand.stiffness_n_per_m = value; });
  all.plain("sway", "m", 0.0, 1.0, axes, &SimulatedDrive::Axis::sway_m);
  all.plain("tremor", "N", 0.0, 10.0, axes, &SimulatedDrive::Axis::tremor_n);
}

void read_what_no_model_has(UriOptions& given, std::vector<SimulatedDrive::Axis>& axes) {
  AxisOptions all(given, axes.size());
  all.plain("backlash", "m", 0.0, 0.1, axes, &SimulatedDrive::Axis::backlash_m);
  all.plain("cogging", "N", 0.0, 100.0, axes, &SimulatedDrive::Axis::cogging_n);
  all.plain("cogging_period", "m", 1e-5, 10.0, axes, &SimulatedDrive::Axis::cogging_period_m);
  all.plain("flexible", "N/m", 0.0, 1e7, axes, &SimulatedDrive::Axis::flexible_n_per_m);
  all.plain("flexible_damping", "Ns/m", 0.0, 1e4, axes, &SimulatedDrive::Axis::flexible_n_s_per_m);
  all.plain("flexible_share", "1", 0.05, 0.95, axes, &SimulatedDrive::Axis::flexible_share);
}

/// A model is rehearsed by what it knows alone.
void require_known(const std::vector<SimulatedDrive::Axis>& axes, const std::string& file) {
  constexpr std::array<std::pair<const char*, Known AxisModel::*>, 5> needed{
      {{"mass", &AxisModel::mass},
       {"viscous", &AxisModel::viscous},
       {"coulomb", &AxisModel::coulomb_up},
       {"coulomb_down", &AxisModel::coulomb_down},
       {"delay", &AxisModel::delay}}};
  for (const SimulatedDrive::Axis& axis : axes) {
    for (const auto& [option, member] : needed) {
      if (axis.model.*member) continue;
      throw DeviceError(fmt::format("{}: the model does not know '{}' of axis '{}'; give {}= in the URI",
                                    file, option, axis.model.name, option));
    }
    if (!(axis.model.limits.lower < axis.model.limits.upper))
      throw DeviceError(
          fmt::format("{}: the model does not know the range of axis '{}'; give range= in the URI", file,
                      axis.model.name));
  }
}

}  // namespace

SimulatedDrive::Options SimulatedDrive::parse_options(Uri uri) {
  UriOptions given(std::move(uri));
  Options options;
  options.axes = axes_to_begin_with(given, options);
  options.seed = given.count("seed", 1);
  options.with_hand = given.flag("hand", true);
  options.with_noise = given.flag("noise", true);
  options.with_encoder = given.flag("encoder", true);
  options.with_truth = given.flag("truth", false);
  options.with_sensor = given.flag("sensor", true);
  options.with_motor = given.flag("motor", true);
  options.tells_mechanics = given.flag("tells", true);
  options.motor_sign = sign_of(given, "sign");
  options.sensor_sign = sign_of(given, "sensor_sign");
  options.sensor_noise_n = given.number("sensor_noise", {"N", options.sensor_noise_n, 0.0, 10.0});
  options.encoder_noise = given.number("encoder_noise", {"m", 0.0, 0.0, 0.1});
  options.serial = given.text("serial");
  read_model(given, options.axes);
  read_hand(given, options.axes);
  read_what_no_model_has(given, options.axes);
  given.allow("fault");
  given.refuse_others();
  require_known(options.axes, options.model_file.empty() ? "device 'sim:axis'" : options.model_file);
  return options;
}

}  // namespace kerf::drivers

#include "kerf/drivers/device_model.h"

#include <algorithm>

#include <fmt/format.h>

namespace kerf::drivers {

double GravityTable::at(double place) const noexcept {
  const auto above = std::ranges::upper_bound(position, place);
  if (above == position.begin()) return force.front();
  if (above == position.end()) return force.back();
  const auto i = static_cast<std::size_t>(above - position.begin());
  const double share = (place - position[i - 1]) / (position[i] - position[i - 1]);
  return force[i - 1] + share * (force[i] - force[i - 1]);
}

std::optional<double> AxisModel::coulomb() const noexcept {
  if (!coulomb_up || !coulomb_down) return std::nullopt;
  return 0.5 * (coulomb_up->value + coulomb_down->value);
}

std::optional<Mechanics> AxisModel::mechanics() const noexcept {
  const std::optional<double> dry = coulomb();
  if (!mass || !viscous || !dry) return std::nullopt;
  return Mechanics{.mass_kg = mass->value, .viscous_n_s_per_m = viscous->value, .coulomb_n = *dry};
}

const AxisModel* DeviceModel::axis(std::string_view name) const noexcept {
  const auto found = std::ranges::find(axes, name, &AxisModel::name);
  return found == axes.end() ? nullptr : &*found;
}

std::optional<bool> DeviceModel::fits() const noexcept {
  bool all = true;
  for (const AxisModel& one : axes) {
    if (one.validation.fits == false) return false;
    all = all && one.validation.fits.has_value();
  }
  return all ? std::optional(true) : std::nullopt;
}

std::vector<std::string> DeviceModel::why_not() const {
  std::vector<std::string> all;
  for (const AxisModel& one : axes) {
    for (const std::string& why : one.validation.why_not) all.push_back(fmt::format("{}: {}", one.name, why));
  }
  return all;
}

const std::array<AxisNumber, 13>& axis_numbers() noexcept {
  using Unit = AxisNumber::Unit;
  static constexpr std::array<AxisNumber, 13> numbers{
      {{"mass", Unit::mass, false, &AxisModel::mass},
       {"viscous", Unit::damping, false, &AxisModel::viscous},
       {"coulomb_up", Unit::force, false, &AxisModel::coulomb_up},
       {"coulomb_down", Unit::force, false, &AxisModel::coulomb_down},
       {"gravity", Unit::force, true, &AxisModel::gravity},
       {"stiffness", Unit::stiffness, false, &AxisModel::stiffness},
       {"delay", Unit::time, false, &AxisModel::delay},
       {"delay_jitter", Unit::time, false, &AxisModel::delay_jitter},
       {"encoder_step", Unit::position, false, &AxisModel::encoder_step},
       {"velocity_noise", Unit::speed, false, &AxisModel::velocity_noise},
       {"velocity_corner", Unit::corner, false, &AxisModel::velocity_corner},
       {"motor_constant", Unit::ratio, true, &AxisModel::motor_constant},
       {"saturation", Unit::force, false, &AxisModel::saturation}}};
  return numbers;
}

const std::array<AxisNumber, 3>& hand_numbers() noexcept {
  using Unit = AxisNumber::Unit;
  static constexpr std::array<AxisNumber, 3> numbers{
      {{"mass", Unit::mass, false, &AxisModel::hand_mass},
       {"damping", Unit::damping, false, &AxisModel::hand_damping},
       {"stiffness", Unit::stiffness, false, &AxisModel::hand_stiffness}}};
  return numbers;
}

std::string unit_of(const AxisNumber& number, const AxisModel& axis) {
  const bool turns = axis.force_unit == "N·m";
  switch (number.unit) {
    case AxisNumber::Unit::mass:
      return turns ? "kg·m²" : "kg";
    case AxisNumber::Unit::damping:
      return turns ? "N·m·s/rad" : "N·s/m";
    case AxisNumber::Unit::force:
      return axis.force_unit;
    case AxisNumber::Unit::stiffness:
      return turns ? "N·m/rad" : "N/m";
    case AxisNumber::Unit::time:
      return "s";
    case AxisNumber::Unit::position:
      return axis.position_unit;
    case AxisNumber::Unit::speed:
      return axis.position_unit + "/s";
    case AxisNumber::Unit::corner:
      return "rad/s";
    case AxisNumber::Unit::ratio:
      break;
  }
  return "1";
}

AxisModel axis_model_of(const AxisInfo& axis) {
  AxisModel model;
  model.name = axis.name;
  model.position_unit = axis.position_unit;
  model.force_unit = axis.force_unit;
  model.lever = axis.lever;
  model.limits = {.lower = axis.lower,
                  .upper = axis.upper,
                  .force = axis.force_limit,
                  .slew = axis.slew_limit,
                  .speed = axis.speed_limit,
                  .acceleration = axis.acceleration_limit};
  return model;
}

}  // namespace kerf::drivers

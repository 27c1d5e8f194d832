#include "kerf/models/scissors.h"

#include <stdexcept>

namespace kerf::models {

std::vector<OptionInfo> ScissorsGeometry::options() {
  const ScissorsGeometry standard;
  return {{"pivot_half_width", standard.pivot_half_width_m, "t_max, half a blade's width at the pivot [m]"},
          {"tip_half_width", standard.tip_half_width_m, "t_min, half a blade's width at the tip [m]"},
          {"blade_length", standard.blade_length_m, "l_t [m]"},
          {"widest_angle", standard.widest_angle_rad, "angle at which the blades lose contact [rad]"}};
}

ScissorsGeometry ScissorsGeometry::make(const OptionReader& reader) {
  const ScissorsGeometry scissors{.pivot_half_width_m = reader.number("pivot_half_width", 1e-6, 10.0),
                                  .tip_half_width_m = reader.number("tip_half_width", 1e-6, 10.0),
                                  .blade_length_m = reader.number("blade_length", 1e-6, 10.0),
                                  .widest_angle_rad = reader.number("widest_angle", 1e-3, 3.1)};
  if (!(scissors.tip_half_width_m < scissors.pivot_half_width_m)) {
    throw std::invalid_argument("scissors: option 'tip_half_width' must be smaller than 'pivot_half_width'");
  }
  if (!(scissors.closing_angle() < scissors.widest_angle_rad)) {
    throw std::invalid_argument(
        "scissors: option 'widest_angle' must be greater than the closing angle 2 atan(tip_half_width / "
        "blade_length)");
  }
  return scissors;
}

}  // namespace kerf::models

#include "kerf/models/scissors.h"

#include <stdexcept>

namespace kerf::models {

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

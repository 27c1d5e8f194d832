#include "kerf/models/branch.h"

namespace kerf::models {

std::vector<OptionInfo> BranchSelector::options() {
  return {
      {"velocity_corner", 0.0, "corner of the velocity filter [rad/s]; 0: the measured velocity"},
      {"ramp_band", 0.0, "speed below which the force fades to zero [position/s]; 0: none"},
      {"reversal_scale", 0.0, "k_s, force regained per travel after a reversal [1/position]; 0: at once"}};
}

BranchSelector BranchSelector::make(const OptionReader& reader) {
  return {.velocity_corner = reader.number("velocity_corner", 0.0, 1e6),
          .ramp_band = reader.number("ramp_band", 0.0, 1e6),
          .reversal_scale = reader.number("reversal_scale", 0.0, 1e9)};
}

}  // namespace kerf::models

#pragma once

#include <string>

namespace kerf::test {

/// The law of a wall that is pressed from above: 400 N/m below a height, and a viscous arm beside the spring.
inline std::string wall_below(double height_m, const std::string& damping_n_s_per_m) {
  return R"(model = "kelvin"
axis = "z"
position_unit = "m"
force_unit = "N"

[contact]
position = { value = )" +
         std::to_string(height_m) + R"(, unit = "m" }
direction = "decreasing"

[parameters]
parallel_stiffness = { value = 400, unit = "N/m" }
series_stiffness = { value = 100, unit = "N/m" }
damping = { value = )" +
         damping_n_s_per_m + R"(, unit = "N·s/m" }
)";
}

}  // namespace kerf::test

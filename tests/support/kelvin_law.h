#pragma once

namespace kerf::test {

/// A Kelvin law between the blades of scissors, as a law file.
inline constexpr const char* kelvin_law = R"(model = "kelvin"
axis = "theta"
position_unit = "rad"
[contact]
position = { value = 30, unit = "deg" }
direction = "decreasing"
[parameters]
parallel_stiffness = { value = 5.0, unit = "N/rad" }
series_stiffness = { value = 8.0, unit = "N/rad" }
damping = { value = 1.6, unit = "N·s/rad" }
)";

}  // namespace kerf::test

#pragma once

namespace kerf::drivers {

/// Counts the changes of what drivers take for the directions of counters and motors (docs/devices.md,
/// Signs): one more with each, because what a probe has found out about the directions before holds no
/// longer.
inline constexpr int sign_tables_version = 1;

}  // namespace kerf::drivers

#pragma once

#include <limits>

#include "laws/law_toml.h"
#include "scene/trajectory.h"

namespace kerf::bench {

/// A number that a scene's file gives under `key`, in SI.
struct SceneNumber {
  std::string_view key;
  std::string_view unit;  ///< SI
  double standard = 0.0;  ///< if it is not given
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool required = false;
};
/// @throws std::invalid_argument with file, line, found and expected, also for a number out of its range.
[[nodiscard]] double read_number(const Place& place, const toml::table& table, const SceneNumber& about);

/// No script goes on for longer.
inline constexpr double longest_motion_s = 3600.0;
/// A duration. @throws as above.
[[nodiscard]] double read_seconds(const Place& place, const toml::table& table, std::string_view key,
                                  double standard, double lower, double upper = longest_motion_s);

/// The table [trajectory] of a scene on a simulated device. @throws std::invalid_argument as above.
[[nodiscard]] Trajectory read_trajectory(const Place& place, const toml::table& table,
                                         const drivers::DeviceInfo& device);

}  // namespace kerf::bench

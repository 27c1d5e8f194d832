#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "laws/law_file.h"
#include "stability/findings.h"
#include "stability/tool_way.h"

namespace kerf::bench {

/// Which axis to study, in which hand. What is not given is as the device's driver knows it.
struct AxisRequest {
  std::string device_uri = "sim:scissors";
  std::string axis;           ///< empty: the law's, else the first
  WayRequest way;             ///< through a law on several axes
  std::string grip = "none";  ///< grip_named()
  double rate_hz = 1000.0;
  double delay_s = 0.0;
  std::optional<double> mass_kg, viscous_n_s_per_m, coulomb_n, encoder_step_m, velocity_corner_rad_s;
  std::optional<double> hand_mass_kg, hand_damping_n_s_per_m, hand_stiffness_n_per_m;
};

/// What of it to study.
struct StudyOptions {
  AxisRequest on;
  std::size_t cells = 100;  ///< along each side of a map
  MapOptions map;

  std::vector<double> stiffness_n_per_m;  ///< lower and upper end of the walls; empty: wall_grid()
  std::vector<double> damping_n_s_per_m;  ///< likewise
  WallTrial trial{.seconds = 2.0, .push_n = 2.0};

  ToolRange range;  ///< of a law
};

/// A law's map has so many cells a side at most: each is a hundred strokes.
inline constexpr std::size_t max_law_cells = 60;

/// Walls on an axis. @throws std::invalid_argument: no such axis, its mass and friction are not known and not
/// given, a range that is none; drivers::DeviceError; std::system_error if it was stopped.
[[nodiscard]] Findings study_walls(const StudyOptions& options);

/// Limits and map of a law, and whether it is passive over the range and stable in the hand.
struct LawFindings {
  Findings findings;
  bool holds = true;
};
/// `name` stands for the law in messages. @throws as study_walls() and place_way(), and for a way through a
/// law along one axis.
[[nodiscard]] LawFindings study_law(const LawFile& law, const std::string& name, const StudyOptions& options);

}  // namespace kerf::bench

#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "device_model/kept_models.h"
#include "laws/law_file.h"
#include "stability/device/axis_request.h"
#include "stability/findings.h"
#include "stability/plane/plane.h"
#include "stability/several/several_device.h"
#include "stability/zwidth/z_width.h"

namespace kerf::bench {

/// A Z-width as somebody asks for it; its ladder is of `damping_n_s_per_m`, and empty: five from 0 to 10
/// N·s/m.
struct ZWidthRequest {
  WallSearchOptions search;
  std::size_t rungs = 5;
  double model_error = 0.0;  ///< half of the interval of 95 % of mass, friction and hand, as a share
  std::size_t draws = 40;    ///< of the model, for its band
  /// A model that was just made, in place of the one that `on` names, and judged in the hand that it was made
  /// in.
  std::optional<ModelFile> fresh_model{};
  ShowProgress progress = show_no_progress;
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

  std::vector<double> wall_n_per_m;  ///< of a plane; empty: a quarter of, once and four times 2 b / T
  PlaneTrial plane_trial;
  SeveralRequest several;
  ZWidthRequest z_width;
  bool sensor_at_hand = false;  ///< of controllers: the force sensor reads what the hand exerts
};

/// A law's map has so many cells a side at most: each is a hundred strokes.
inline constexpr std::size_t max_law_cells = 60;
/// A plane has so many, each two trials; several axes so many directions.
inline constexpr std::size_t max_plane_cells = 60;
inline constexpr std::size_t max_directions = 72;

/// Walls on an axis. Whose model was taken says the first line, and the object `device_model`. @throws
/// std::invalid_argument: no such axis, its mass and friction are not known and not given, a range that is
/// none; drivers::DeviceError; std::system_error if it was stopped.
[[nodiscard]] Findings study_walls(const StudyOptions& options);

/// Diolaiti's plane of an axis, with walls of the device in it. @throws as study_walls(), and for an axis
/// without an encoder step.
[[nodiscard]] Findings study_plane(const StudyOptions& options);

/// Several axes at once, over the directions of a wall. @throws as several_axes() and direction_map().
[[nodiscard]] Findings study_several(const StudyOptions& options);

/// The search of a Z-width, for whoever refuses one before anything moves.
/// @throws std::invalid_argument naming what is out of range.
[[nodiscard]] WallSearchOptions z_width_search(const StudyOptions& options);

/// Z-width of a device through its loop, beside what its model says in the hand of `on`; without theory where
/// mass and friction are neither known nor given. `stop` ends it early, and what was found is kept.
/// @throws as measure_z_width().
[[nodiscard]] Findings study_z_width(const StudyOptions& options, const std::atomic<bool>& stop);

/// Controllers of a wall on a device, by the same searches at the dampings that are asked for, else without
/// damping; the transparency on the first of `wall_n_per_m`, if there is one. Each is designed for the model
/// of the device. @throws as study_z_width() and compare_controllers(), and where mass and friction are
/// neither known nor given.
[[nodiscard]] Findings study_controllers(const StudyOptions& options, const std::atomic<bool>& stop);

/// Limits and map of a law, and whether it is met, passive over the range and stable in the hand.
struct LawFindings {
  Findings findings;
  bool holds = true;
};
/// `name` stands for the law in messages. @throws as study_walls() and place_way(), and for a way through a
/// law along one axis.
[[nodiscard]] LawFindings study_law(const LawFile& law, const std::string& name, const StudyOptions& options);

}  // namespace kerf::bench

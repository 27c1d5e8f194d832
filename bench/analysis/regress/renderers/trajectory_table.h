#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/spatial.h>

#include "laws/sampled_motion.h"
#include "regress/renderers/number_table.h"

namespace kerf::bench {

/// How the motion of axes is written for a renderer.
struct TrajectoryColumns {
  std::vector<models::LawAxis> axes;
  /// "wxyz" or "xyzw": the turn of the rotation vector rx, ry, rz stands behind the axes as a quaternion, in
  /// that order; empty: it does not.
  std::string quaternion{};

  /// `tick`, `time[s]`, of every axis position and speed, `qw[1]` and the others, `period[s]`.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Appends the row of a tick, in digits that give the same doubles, without an end of line.
  void append_row(std::string& text, const SampledMotion& motion, std::size_t tick) const;
  /// One of w, x, y, z of the quaternion (cos(a/2), sin(a/2) r/a) of the rotation vector r of length a.
  [[nodiscard]] double turn(const models::SpatialMotion& sample, char part) const;
};

/// Whether among the axes there are rx, ry and rz in rad, of which a quaternion can be made.
[[nodiscard]] bool turn_in_space(const std::vector<models::LawAxis>& axes);

/// A motion as a renderer reads it, a row a tick, and back: without a period that of the times.
[[nodiscard]] std::string trajectory_csv(const SampledMotion& motion, const TrajectoryColumns& columns);
/// @throws std::invalid_argument that names the file, as read_number_table(); for a missing column, a row
/// that is not finite, time that does not grow, a quaternion that is another turn than rx, ry, rz.
[[nodiscard]] SampledMotion motion_of(const NumberTable& table, const std::vector<models::LawAxis>& axes,
                                      const std::filesystem::path& file);
[[nodiscard]] SampledMotion read_trajectory_csv(const std::filesystem::path& file,
                                                const std::vector<models::LawAxis>& axes);

}  // namespace kerf::bench

#pragma once

#include <string>

#include "stability/device/axis_request.h"
#include "stability/several/directions.h"

namespace kerf::bench {

/// Several axes and the shape of the wall that they meet.
struct SeveralAxes {
  std::string of;  ///< the file or the device
  NamedAxes axes;
  TurningWall shape;  ///< its largest stiffness is 1
};

/// What a person asks for, beside the device.
struct SeveralRequest {
  std::string of;             ///< FILE.toml, or the URI of a device
  double across = 1.0;        ///< stiffness across the direction, as a share of that along it; not of a file
  double wall_damping = 0.0;  ///< [N·s/m], in all directions; not of a file
  double rotation_rad_s = 0.0;  ///< of the tool; not of a file
  bool drags = false;           ///< not of a file
};

/// A file in TOML:
///
///     axes = ["x", "y"]                        # 1 to 6 names
///     mass_kg = [[0.2, 0.05], [0.05, 0.1]]
///     viscous_n_s_per_m = [[0.4, 0], [0, 0.2]]
///
///     [wall]                                   # all of it optional
///     stiffness = [[1, 0], [0, 0.3]]           # its shape: the boundary is k times this; standard: the unit
///     matrix damping_n_s_per_m = [[0, 0], [0, 0]] plane = ["x", "y"]                       # in which its
///     direction is varied; standard: the first two
///
///     [tool]
///     rotation_rad_s = 6.28                    # turns with the wall in that plane
///     drags = false                            # TurningWall
///
/// or a device: its axes in metres of travel, independent of each other, or `sim:premium`, whose axes x, y, z
/// are those of its tip at the joint angles that `--from` names (default: 0), with H(q) of
/// mechanisms::Premium and the simulation's friction, brought to the tip by its Jacobian.
///
/// Rate, delay, filter and grip are those of `on`; a grip holds all axes alike.
/// @throws std::invalid_argument with file and line, or naming the axis whose mass is not known.
[[nodiscard]] SeveralAxes several_axes(const SeveralRequest& request, const AxisRequest& on);

}  // namespace kerf::bench

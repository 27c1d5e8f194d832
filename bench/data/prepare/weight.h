#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// What hangs on a force sensor: with R the rotation from the sensor's frame to the world's (of the rotation
/// vector rx, ry, rz) and g = (0, 0, -9.80665) m/s^2, z up,
///
///     f = f_bias + m R^T g,    t = t_bias + c x (m R^T g)
///
/// in the sensor's frame, while nothing is touched.
struct Weight {
  double mass_kg = 0.0;
  double mass_error_kg = 0.0;  ///< standard errors are zero for what was given
  std::array<double, 3> centre_m{};
  std::array<double, 3> centre_error_m{};
  std::array<double, 3> force_bias_n{};  ///< zero for a weight that was given: then no bias is taken off
  std::array<double, 3> torque_bias_nm{};
  bool has_torque = false;  ///< there are torques, so there is a centre
  bool estimated = false;
  std::size_t rows = 0;        ///< free rows that it was estimated from
  double condition = 0.0;      ///< of the equations, 1 is best
  double tilt_deg = 0.0;       ///< root mean square angle of the free rows' vertical from its mean
  double force_noise_n = 0.0;  ///< standard deviation of the free rows about the model
};

struct WeightOptions {
  std::optional<double> mass_kg;  ///< known: nothing is estimated
  std::array<double, 3> centre_m{};
  bool base_frame = false;  ///< the forces stand in the world's axes, not the sensor's; an import of six
                            ///< axes says itself that they do, and that its torques are generalised
};

/// Takes the tool's weight off the measured force of a recording with axes x, y, z (force in N) and rx, ry,
/// rz (rad; torques in N·m count where they are finite). Mass, centre and bias come from the free rows by
/// linear least squares unless the mass is given.
/// @throws std::invalid_argument if axes are missing, there are too few free rows, or their orientations do
/// not tell weight from bias (one of them seen alone, or tilts about one axis alone where the centre is asked
/// for).
Weight remove_weight(schema::Recording& recording, const std::vector<bool>& free,
                     const WeightOptions& options);

}  // namespace kerf::bench

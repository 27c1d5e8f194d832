#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <kerf/fitting/calibration/holds.h>

namespace kerf::bench {

/// fx, fy, fz [N], tx, ty, tz [N·m] on the sensor, in its own frame.
using Wrench = Eigen::Matrix<double, 6, 1>;

inline constexpr double standard_gravity = 9.80665;  ///< [m/s²]
/// Half of the span of gravity over the Earth's surface, 9.780 to 9.832 m/s², in shares.
inline constexpr double gravity_span = 0.027 / standard_gravity;

/// A part of a load that is not known exactly, of standard deviation 1: by its name, so that loads that share
/// it are wrong together.
struct LoadError {
  std::string source;  ///< "weight a", "direction of x up", ...
  Wrench effect;
};

/// One load to be put on and held.
struct LoadStep {
  std::size_t number = 0;  ///< from 1
  std::string series;
  std::string words;  ///< "0.5 kg along +x at 0, 0, 20 mm"
  Wrench load = Wrench::Zero();
  std::vector<LoadError> errors;
  std::size_t load_number = 0;
  std::size_t placement = 0;  ///< of its series
  std::size_t tare = 0;
  double hold_s = 2.0;
};

struct LoadScript {
  std::string serial_number;  ///< of the transducer; empty: not said
  std::string provenance;
  std::optional<Wrench> capacity;
  bool knows_gravity = false;
  double gravity = standard_gravity;
  std::vector<LoadStep> steps;
};

struct GravityOption {
  std::optional<double> gravity;  ///< instead of the script's
};

/// Reads a script of loads (docs/calibrating.md has its keys) and takes it apart: each series without load,
/// up, down, without load.
/// @throws std::invalid_argument in one line: file, what, expected; loads beyond the capacity are refused.
[[nodiscard]] LoadScript read_load_script(const std::string& file, const GravityOption& option);

/// G of steps, in the order given: Holds::load_error of the chosen components.
[[nodiscard]] Eigen::MatrixXd load_errors(const std::vector<const LoadStep*>& steps,
                                          const std::vector<std::size_t>& components);

}  // namespace kerf::bench

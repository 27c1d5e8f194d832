#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "laws/law_file.h"

namespace kerf::bench {

/// How far a rendered force may be from the stored one: as far as the largest of what is given,
///
///     |got - expected| <= max(absolute, relative |expected|, jnd JND(expected)),
///
/// or not at all, bit for bit.
struct Tolerance {
  std::optional<double> force_n;     ///< of channels in N
  std::optional<double> torque_n_m;  ///< of channels in N·m
  std::optional<double> relative;
  std::optional<double> jnd;  ///< in JNDs of the expected force or torque
  bool exact = false;
};

/// Stays in one place.
struct Rest {
  double at = 0.0;
};
/// To and fro with minimum jerk, a pause before every stroke.
struct StrokesToAndFro {
  double from = 0.0;
  double to = 0.0;
  double stroke_s = 0.4;
  double pause_s = 0.1;
};
/// x = centre + amplitude sin(2 pi f t + phase)
struct Sine {
  double centre = 0.0;
  double amplitude = 0.0;
  double frequency_hz = 1.0;
  double phase_rad = 0.0;
};
/// Rests, goes at constant speed, holds, and goes back if there is time for it.
struct RampAndHold {
  double from = 0.0;
  double to = 0.0;
  double start_s = 0.1;
  double ramp_s = 0.2;
  double hold_s = 0.4;
};

/// What one axis of a trajectory does. Positions in the axis' own unit.
struct ScriptedAxis {
  std::size_t axis = 0;  ///< of the law's
  std::variant<Rest, StrokesToAndFro, Sine, RampAndHold> script;
};

/// A law, a trajectory and how exactly the forces have to be those stored. The trajectory is that of a
/// recording, of a scene's script, or of motions given axis by axis.
struct RegressionCase {
  std::string name;
  std::filesystem::path law_file;
  LawFile law;
  std::filesystem::path recording;
  std::filesystem::path scene;
  std::vector<ScriptedAxis> motion;
  double rate_hz = 1000.0;        ///< of a scripted trajectory
  std::optional<double> seconds;  ///< of a scripted one without it 1; of the others all there is
  Tolerance tolerance;
  std::optional<double> tick_cost;  ///< how many times its stored cost a tick may cost
};

struct Suite {
  std::string name;
  std::filesystem::path file;
  std::filesystem::path stored;  ///< SUITE.h5 beside SUITE.toml
  std::vector<RegressionCase> cases;
};

/// Reads a suite and the laws that it names; paths are relative to its folder. docs/regress.md has the
/// format. @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Suite read_suite(const std::filesystem::path& file);

/// The suite with these cases alone, in the suite's order; all of them if none is named.
/// @throws std::invalid_argument for a name that is none.
[[nodiscard]] Suite only(const Suite& suite, const std::vector<std::string>& names);

/// The axes that a law acts on, with their units; a scalar law has one.
[[nodiscard]] std::vector<models::LawAxis> axes_of(const LawFile& law);

}  // namespace kerf::bench

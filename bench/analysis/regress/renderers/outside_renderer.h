#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/models/spatial.h>

#include "laws/sampled_motion.h"
#include "regress/forces.h"

namespace kerf::bench {

/// How a renderer is asked tick by tick.
struct Lockstep {
  bool socket = false;       ///< over a socket, {socket} of its command, not over its standard streams
  bool by_the_wall = false;  ///< each tick at its time; else as soon as the one before is answered
  double answer_s = 10.0;    ///< how long the answer to a tick may take; to the hello as long as the case
};

/// A renderer that is no law of Kerf: a program that is run once a case, or a file of forces that it has
/// written. docs/regress.md has the files.
struct OutsideRenderer {
  std::vector<std::string> command;  ///< with {trajectory}, {forces} and {seed}; empty: `forces` is there
  std::optional<Lockstep> lockstep;  ///< none: the command reads and writes files
  std::vector<std::string> version;  ///< a command that prints the program's version; empty: none
  std::filesystem::path forces;      ///< of a run already made
  std::filesystem::path folder;      ///< of the suite, where it runs
  double timeout_s = 60.0;
  std::uint64_t seed = 1;
  std::string sign = "resisting";     ///< or "on the hand"
  std::string frame;                  ///< what its axes are, for people; a file that names another is refused
  std::string quaternion;             ///< of rx, ry, rz in its trajectory: TrajectoryColumns::quaternion
  std::vector<models::LawAxis> axes;  ///< at least one
  std::optional<double> compute_times;   ///< how many times what is stored its ticks may take, by the median
  std::optional<double> compute_time_s;  ///< how long 99 of 100 ticks may take at most
};

/// How it is called, for people and beside its forces.
[[nodiscard]] std::string called(const OutsideRenderer& renderer);

/// SHA-256 of all that bears on its forces as far as it is seen: command, seed, sign, frame, axes, and the
/// content of every file that the command names from the suite's folder, the program first.
[[nodiscard]] std::string checksum(const OutsideRenderer& renderer);

/// Its forces along a motion, by a process of its own that begins with nothing kept.
/// @throws std::invalid_argument in one line: as run_program(), read_number_table() and render_in_lockstep();
/// other columns or units, another sign or frame, another number of rows than ticks, a row of another time.
[[nodiscard]] RenderedForces render_forces(const OutsideRenderer& renderer, const SampledMotion& motion);

}  // namespace kerf::bench

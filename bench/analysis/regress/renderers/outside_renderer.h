#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <kerf/models/spatial.h>

#include "laws/sampled_motion.h"
#include "regress/forces.h"

namespace kerf::bench {

/// A renderer that is no law of Kerf: a program that is run once a case, or a file of forces that it has
/// written. docs/regress.md has the files.
struct OutsideRenderer {
  std::vector<std::string> command;  ///< with {trajectory}, {forces} and {seed}; empty: `forces` is there
  std::filesystem::path forces;      ///< of a run already made
  std::filesystem::path folder;      ///< of the suite, where it runs
  double timeout_s = 60.0;
  std::uint64_t seed = 1;
  std::string sign = "resisting";     ///< or "on the hand"
  std::string frame;                  ///< what its axes are, for people; a file that names another is refused
  std::vector<models::LawAxis> axes;  ///< at least one
};

/// How it is called, for people and beside its forces.
[[nodiscard]] std::string called(const OutsideRenderer& renderer);

/// SHA-256 of all that bears on its forces as far as it is seen: command, seed, sign, frame, axes, and the
/// content of every file that the command names from the suite's folder, the program first.
[[nodiscard]] std::string checksum(const OutsideRenderer& renderer);

/// Its forces along a motion, by a process of its own that begins with nothing kept.
/// @throws std::invalid_argument in one line: as run_program() and read_number_table(); other columns or
/// units, another sign or frame, another number of rows than ticks, a row of another time.
[[nodiscard]] RenderedForces render_forces(const OutsideRenderer& renderer, const SampledMotion& motion);

/// A motion as a renderer reads it: tick, time, position and speed of every axis and the
/// period, with 17 digits, and back: without a period that of the times.
[[nodiscard]] std::string trajectory_csv(const SampledMotion& motion,
                                         const std::vector<models::LawAxis>& axes);
/// @throws std::invalid_argument as read_number_table(); for a missing column, a row that is not finite, time
/// that does not grow.
[[nodiscard]] SampledMotion read_trajectory_csv(const std::filesystem::path& file,
                                                const std::vector<models::LawAxis>& axes);

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <kerf/compare/series.h>

namespace kerf::bench {

/// What a recording says of its force: a sensor's resists the tool, a commanded one acts on the hand.
enum class ForceSense : std::uint8_t { unknown, measured, commanded };

enum class RunKind : std::uint8_t { table, recording, stored };

/// A run to be compared, and what is to be known of how it was read.
struct ComparedRun {
  std::string name;
  compare::Series series;
  std::vector<std::string> notes;
  ForceSense sense = ForceSense::unknown;
  RunKind kind = RunKind::table;
};

/// Which force of a file.
struct ComparedForce {
  bool measured = false;  ///< of a recording that of its sensor, though one was commanded
  std::string channel;    ///< this one alone; empty: all
  std::string stored;     ///< the case, of a suite's stored forces; empty: the only one
};

/// Reads a recording or a suite's stored forces (.h5), or a table of numbers: text, a workbook, what
/// kerf::FileText reads. Of a table every column with a unit of a force or a torque is a channel, one in
/// seconds is the time, and those of positions and speeds stand beside them; the others are left out and
/// named.
/// @throws std::invalid_argument for a file without a force or without that case, with a line that is no row,
/// or as the readers do.
[[nodiscard]] ComparedRun read_run(const std::filesystem::path& file, const ComparedForce& force);

/// Refuses what was asked of files that neither run is.
void require_kinds_of(const ComparedForce& force, const ComparedRun& expected, const ComparedRun& got);

/// Where one force was measured and the other commanded, turns the commanded one to resist the tool too, with
/// a note.
void bring_to_one_sense(ComparedRun& expected, ComparedRun& got);

}  // namespace kerf::bench

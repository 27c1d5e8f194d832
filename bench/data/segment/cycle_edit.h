#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

#include "inspect/cycle_flags.h"
#include "segment/segment.h"

namespace kerf::bench {

/// Cycles as a person wants them.
struct CycleEdit {
  std::optional<SegmentOptions> found_by;  ///< settings by which they are found anew; none: those stored
  /// The same phases of the same cycles, of other rows; empty: as they were found or are stored.
  std::vector<schema::PhaseSpan> phases;
  /// What a person says of cycles: "by_hand" leaves one out, "accepted" takes one whatever is found.
  std::vector<schema::CycleFlag> said;
};

/// What an edit comes to, before it is kept.
struct EditedCycles {
  schema::Cycles cycles;
  std::vector<FlaggedCycle> flagged;  ///< what is wrong with each, and what was said of it
};

/// Cycles of a recording with an edit: branches and flags are those of the rows that the phases have now;
/// grid, direction and contact stay as they were found. `felt` is the force from which contact is told.
/// @throws std::invalid_argument in a line that names the cycle: for phases that overlap, hold no row, are of
///         other cycles than there are or beyond the recording; for what is said of no cycle or without a
///         reason; without cycles; and as find_cycles().
[[nodiscard]] EditedCycles edited_cycles(const schema::RecordedRows& rows, const CycleEdit& edit,
                                         double felt);

/// What the edit changes in a recording, a sentence each: boundaries with their times, cycles that are left
/// out or taken, with the reasons.
[[nodiscard]] std::vector<std::string> changes_by(const schema::RecordedRows& rows, const CycleEdit& edit,
                                                  const EditedCycles& edited);

/// Who edits: 1 to 60 bytes without line breaks and ":". @throws std::invalid_argument.
void check_author(std::string_view author);

/// The recording with the edit, and a line in its history: "cycles edited by AUTHOR: " and what changed.
[[nodiscard]] schema::Recording with_edit(const schema::RecordedRows& rows, const CycleEdit& edit,
                                          const EditedCycles& edited, double felt, std::string_view author);

/// An edit of the cycles as a recording's history tells it.
struct ToldEdit {
  std::string time;  ///< ISO 8601, UTC
  std::string author;
  std::string what;
};
/// Those since `kerf segment` last found the cycles, the oldest first.
[[nodiscard]] std::vector<ToldEdit> edits_of(const schema::Header& header);

/// Which cycles a recording has, by which fits go: SHA-256 over axis, direction and phases, and which cycles
/// carry a flag and were not accepted. Empty without cycles.
[[nodiscard]] std::string cycles_sha256_of(const schema::Recording& about);

}  // namespace kerf::bench

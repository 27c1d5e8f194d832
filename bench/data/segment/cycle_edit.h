#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

#include "inspect/cycle_flags.h"
#include "segment/cycle_changes.h"
#include "segment/segment.h"

namespace kerf::bench {

/// Cycles as a person wants them.
struct CycleEdit {
  std::optional<SegmentOptions> found_by;  ///< settings by which they are found anew; none: those stored
  /// Phases of the cycles as they are to be; empty: as they were found or are stored.
  std::vector<schema::PhaseSpan> phases;
  /// What a person says of cycles: "by_hand" leaves one out, "accepted" takes one whatever is found.
  std::vector<schema::CycleFlag> said;
};

/// One cycle made two at a row, or a cycle and the next one made one (cycle_division.h).
struct CycleStep {
  enum class Kind { split, merge };
  Kind kind = Kind::split;
  std::uint32_t cycle = 0;
  std::uint64_t row = 0;  ///< of a split
};
/// The edit with that on top; what is said of a cycle is said of all that come of it, and of two that become
/// one what is said of the first, else of the other. @throws std::invalid_argument as split_cycle().
[[nodiscard]] CycleEdit with_step(const schema::RecordedRows& rows, CycleEdit edit, const CycleStep& step);

/// What an edit comes to, before it is kept.
struct EditedCycles {
  schema::Cycles cycles;
  std::vector<FlaggedCycle> flagged;  ///< what is wrong with each, and what was said of it
};

/// Cycles of a recording with an edit: branches and flags are those of the rows that the phases have now;
/// grid, direction and contact stay as they were found. `felt` is the force from which contact is told.
/// @throws std::invalid_argument in a line that names the cycle: for phases that overlap, hold no row, are
/// not
///         in order or beyond the recording; for a cycle without a closing; for what is said of no cycle or
///         without a reason; without cycles; and as find_cycles().
[[nodiscard]] EditedCycles edited_cycles(const schema::RecordedRows& rows, const CycleEdit& edit,
                                         double felt);

/// What the edit changes in a recording: boundaries, cycles that are split, merged, left out or taken.
[[nodiscard]] std::vector<schema::CycleChange> changes_by(const schema::RecordedRows& rows,
                                                          const CycleEdit& edit, const EditedCycles& edited);

/// What a person has said of cycles, as it stands in a recording.
[[nodiscard]] std::vector<schema::CycleFlag> said_by_hand(const schema::Recording& about);

/// Whoever runs the program; empty if the system does not know a name.
[[nodiscard]] std::string usual_author();

/// Who edits: 1 to 60 bytes without line breaks and ":". @throws std::invalid_argument.
void check_author(std::string_view author);

/// The recording with the edit, which it keeps in `/cycle_edits` and tells of in a line of its history.
[[nodiscard]] schema::Recording with_edit(const schema::RecordedRows& rows, const CycleEdit& edit,
                                          const EditedCycles& edited, double felt, std::string_view author);

/// Which cycles a recording has, by which fits go: SHA-256 over axis, direction and phases, and which cycles
/// carry a flag and were not accepted. Empty without cycles.
[[nodiscard]] std::string cycles_sha256_of(const schema::Recording& about);

}  // namespace kerf::bench

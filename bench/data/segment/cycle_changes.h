#pragma once

#include <string>
#include <vector>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Cycles and what a person has said of them.
struct SaidCycles {
  std::vector<schema::PhaseSpan> phases;
  std::vector<schema::CycleFlag> said;  ///< "by_hand", "accepted"
};

/// What lies between two divisions of the same rows into cycles, without number, time and author. A cycle
/// before and one after are the same where they share more than half of the rows of the shorter one: one that
/// is several was split, several that are one were merged; of those that stayed one, the boundaries that
/// moved. What was said of a cycle is said of all that came of it.
[[nodiscard]] std::vector<schema::CycleChange> changes_between(const schema::RecordedRows& rows,
                                                               const SaidCycles& before,
                                                               const SaidCycles& after);

/// An edit of the cycles as a recording tells it.
struct ToldEdit {
  std::string time;  ///< ISO 8601, UTC
  std::string author;
  std::string what;
};
/// Those since `kerf segment` last found the cycles, the oldest first: by `/cycle_edits`, and where an
/// earlier version kept them in the history alone, by its lines.
[[nodiscard]] std::vector<ToldEdit> edits_of(const schema::Recording& about);

/// Adds an edit to those of a recording, and a line to its history.
void add_edit(schema::Recording& about, std::vector<schema::CycleChange> changes, const std::string& author);

}  // namespace kerf::bench

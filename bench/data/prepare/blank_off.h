#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "prepare/blank.h"
#include "recordings/row_span.h"

namespace kerf::bench {

/// A recording of the tool cutting nothing, and how it is taken off.
struct BlankOptions {
  schema::Recording recording;
  std::string file;           ///< its name, for messages and the history
  std::string sha256;         ///< of its file
  double speed_factor = 2.0;  ///< a stroke that much faster or slower than all of the blank's is not covered
  std::optional<CyclePart> left_out{};  ///< of the blank's cycles
  bool drop = false;  ///< leave out the rows that are not covered, instead of leaving them as they are
};

/// Rows from which nothing was taken, for one reason, and where they are.
struct UncoveredRows {
  std::size_t rows = 0;
  double least = 0.0;  ///< position
  double most = 0.0;
};

/// What was taken off.
struct BlankTaken {
  ToolForce tool;
  std::string axis;
  std::string force_unit;
  std::string position_unit;
  std::string file;
  std::string uuid;
  std::string sha256;
  std::size_t rows = 0;     ///< of the recording
  std::size_t covered = 0;  ///< from which something was taken
  UncoveredRows of_no_cycle;
  UncoveredRows too_fast;  ///< in strokes, or in turns beside them
  UncoveredRows too_slow;
  UncoveredRows out_of_range;  ///< where no blank has been
  bool are_dropped = false;
  std::vector<RowSpan> uncovered;  ///< rows as they were, from which nothing was taken; none if dropped
  // Over the covered rows, root mean squares in the force's unit.
  double force_rms = 0.0;  ///< before
  double taken_rms = 0.0;
  double spread_rms = 0.0;       ///< of the blank from cycle to cycle
  double error_rms = 0.0;        ///< of the blank's mean
  double told_share = 0.0;       ///< of them: where what was taken is beyond two errors of its mean
  double negative_before = 0.0;  ///< share below zero
  double negative_after = 0.0;
  double pulling_share = 0.0;  ///< share below zero by more than two spreads and 0.05 N, after
  double pulling_least = 0.0;  ///< where those are, as positions
  double pulling_most = 0.0;
  double closing_speed = 0.0;  ///< median of the recording's strokes [position unit/s]
  double opening_speed = 0.0;
  std::vector<std::string> warnings;
};

/// Takes the force of the tool off the measured force along the axis of the recording's cycles; of a
/// recording without cycles along its first axis, in cycles that are found.
///
/// A row of a closing has c(x) taken off, one of an opening o(x). In a turn the tool stands, and friction may
/// be anything between both: there it goes from the one to the other in proportion to time; before the first
/// and after the last stroke it is that of the stroke. Branches and their means lose what their rows lose.
/// @throws std::invalid_argument if the blank is of another device, axis or unit or is the recording itself,
///         holds no good cycles, or covers no row.
[[nodiscard]] BlankTaken remove_blank(schema::Recording& recording, const BlankOptions& options);

/// As it stands in the history.
[[nodiscard]] std::string blank_step(const BlankTaken& taken);

}  // namespace kerf::bench

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

namespace kerf::bench {

struct SegmentOptions {
  std::size_t axis = 0;
  double prominence = 0.3;   ///< share of the range of positions that a stroke must cover, in (0, 1)
  double dwell = 0.05;       ///< share of a stroke at either end that counts as turning round, in (0, 0.5)
  double corner_hz = 20.0;   ///< of the zero-phase low-pass, at most a fifth of the rate
  std::size_t points = 101;  ///< of the grid on which cycles are averaged, at least 2
  std::optional<double> closing_direction;  ///< +1 or -1; by default the direction that costs more work
};

/// Finds the cycles of a recording of opening and closing, with their four phases ([Okamura2003],
/// section 3.1).
///
/// Turning points of the low-passed position are those whose prominence exceeds a share of the range, so that
/// neither noise nor a hesitation within a stroke counts. Each closing is one cycle, from 1: the turn from
/// opening to closing before it, the closing, the turn from closing to opening, the opening, as far as they
/// were recorded. Turning round is what happens within a share of the stroke from its ends. Closing is the
/// direction that costs more work, unless it is given; where strokes either way differ by no more than they
/// do among each other, that into which the force grows; of a commanded force, that against it. Forces are
/// low-passed and averaged over the cycles on a uniform grid of positions, NaN where a cycle did not reach.
///
/// Needs no more memory for a day than for a second, but for the cycles themselves: position and force are
/// low-passed block by block, and gone through again for their range, the turns, the work of the strokes and
/// the branches, each of which needs what was found before.
/// @throws std::invalid_argument if there is no such axis, no force, a value that is not finite, a time that
///         goes back, or no closing, saying which.
[[nodiscard]] schema::Cycles find_cycles(const schema::RecordedRows& rows, const SegmentOptions& options);
[[nodiscard]] schema::Cycles find_cycles(const schema::Recording& recording, const SegmentOptions& options);

/// Finds the cycles in the rows of a recording, keeps them in what it says of itself, without the flags of
/// earlier ones, and adds a line to its history; `name` stands for it in messages. @throws as find_cycles()
/// does.
void segment_recording(schema::Recording& recording, const schema::RecordedRows& rows,
                       const SegmentOptions& options, const std::string& name);

/// The mean of branches that were resampled to as many points, where at least half of them reached; NaN
/// elsewhere.
[[nodiscard]] std::vector<double> mean_branch(const std::vector<std::vector<double>>& branches,
                                              std::size_t points);

/// "open_to_close", as the schema has it.
[[nodiscard]] constexpr std::string_view name_of(schema::Phase phase) noexcept {
  constexpr std::array<std::string_view, 5> names{"", "opening", "open_to_close", "closing", "close_to_open"};
  const auto at = static_cast<std::size_t>(phase);
  return at < names.size() ? names[at] : names[0];
}

}  // namespace kerf::bench

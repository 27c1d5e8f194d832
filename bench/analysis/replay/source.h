#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "laws/sampled_motion.h"

namespace kerf::bench {

/// Which rows of a recording are replayed; all of them unless something is said.
struct SelectOptions {
  std::optional<double> from_s;
  std::optional<double> to_s;
  std::vector<std::uint32_t> cycles;  ///< as `kerf segment` numbered them
};

/// Ticks that are not there between two rows that follow each other.
struct Gap {
  std::size_t after = 0;  ///< the row before it, counted in the selection
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Noise of the forces, of each axis; none of what was not recorded.
struct RecordedNoise {
  std::vector<double> commanded;
  std::vector<double> measured;
};

/// Rows to be replayed, in their order, with finite positions and velocities and times that increase.
struct Source {
  schema::Recording recording;
  std::vector<std::size_t> row;  ///< of each row, its number in the file, from 0
  double period_s = 1e-3;        ///< of the loop that recorded it, else the median
  bool on_grid = false;    ///< every time is its tick times the period, to the last bit: a loop recorded it
  bool from_start = true;  ///< the first row of the file is among them
  std::vector<Gap> gaps;
  std::optional<RecordedNoise> noise;  ///< before the forces were resampled, which hides it
};

/// Takes the rows out of a recording; `name` stands for it in messages.
/// @throws std::invalid_argument for a selection without two rows, a cycle that is not there, or a time,
///         position or velocity that cannot be replayed, with its row and time.
[[nodiscard]] Source select_rows(schema::Recording recording, const SelectOptions& options,
                                 const std::string& name);

/// The recording with one of its axes alone.
[[nodiscard]] Source along_axis(Source source, std::size_t axis);

/// Fills every gap by straight lines on the ticks that are missing, flagged as resampled. What nobody
/// recorded there is no recorded force: the forces are NaN.
[[nodiscard]] Source bridged(const Source& source);

/// The same motion `speed` times as fast on ticks of the same period: positions and forces on straight lines
/// between the rows, velocities times the speed. Ticks that fall into a gap are left out, so that a gap stays
/// one. Every row is flagged as resampled.
[[nodiscard]] Source at_speed(const Source& source, double speed);

/// The rows as the loop that recorded them saw them: their periods are those since its tick before.
[[nodiscard]] SampledMotion motion_of(const Source& source);

/// What a replay makes of the gaps, as a sentence; empty if there are none.
[[nodiscard]] std::string gaps_in_words(const Source& source, bool bridge);

}  // namespace kerf::bench

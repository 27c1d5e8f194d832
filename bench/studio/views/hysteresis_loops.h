#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <kerf/models/motion.h>
#include <kerf/schema/recording_file.h>

namespace kerf::bench {

/// The cycles of a recording along an axis: those of `kerf segment`, else what find_cycles() finds in up to
/// 5 million rows.
struct AxisCycles {
  struct Rows {
    std::uint32_t cycle = 0;
    std::uint64_t begin = 0;
    std::uint64_t end = 0;  ///< of all its phases together
  };
  std::vector<Rows> cycles;
  bool segmented_here = false;
  std::string why_none;      ///< empty if there are cycles
  std::size_t averaged = 0;  ///< cycles that are in the averages: those that are not left out
  // The averages of the branches on a grid of positions; empty along another axis than the segmented one.
  std::vector<double> grid;
  std::vector<double> closing;
  std::vector<double> opening;
  models::Contact contact;  ///< by which a commanded force resists
};

/// @throws std::invalid_argument if there is no such axis; FormatError where the file is damaged.
[[nodiscard]] AxisCycles axis_cycles(const schema::RecordingFile& file, std::size_t axis);

/// Force against position along one cycle.
struct ForceLoop {
  std::uint32_t cycle = 0;
  std::uint64_t rows = 0;  ///< of which these are some
  std::vector<double> position;
  std::vector<double> force;  ///< resisting: measured where there is a sensor, else commanded and turned
};

/// Loops to be drawn: cycles `first` (from 1) to `first + count - 1` in their order, of at most 600 points
/// each, or 20,000 in all where that is more. Of every stretch the first and the last row are kept and those
/// of extreme position or force.
[[nodiscard]] std::vector<ForceLoop> force_loops(const schema::RecordingFile& file, std::size_t axis,
                                                 const AxisCycles& cycles, std::size_t first,
                                                 std::size_t count);

/// Force against position along all rows, to be drawn where there are no cycles: at most 6000 points, kept as
/// those of a loop are. Empty without a force, and of more than 5 million rows.
[[nodiscard]] ForceLoop whole_loop(const schema::RecordingFile& file, std::size_t axis,
                                   const AxisCycles& cycles);

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "inspect/counted_rows.h"

namespace kerf::bench {

/// The force of a tool that cuts nothing while it moves one way, on the grid of ToolForce; NaN where fewer
/// than two cycles, or fewer than half of them, have been.
struct BlankBranch {
  std::vector<double> mean;         ///< over cycles of each cycle's mean at a position
  std::vector<double> spread;       ///< standard deviation from cycle to cycle (n - 1)
  std::vector<std::size_t> cycles;  ///< that have been there
  double slowest = 0.0;             ///< mean speed of the slowest stroke [position unit/s]
  double fastest = 0.0;
  double median_speed = 0.0;
};

/// What resists acceleration, in the unit of the force over position/s^2.
struct BlankInertia {
  std::optional<double> value;  ///< least squares; unknown without two cycles or without acceleration
  std::optional<double> error;  ///< standard error, by whole cycles
  double noise_share = 1.0;     ///< of the mean square of the acceleration in strokes, what waiting has, too
  bool is_determined = false;   ///< more than three errors above zero, and less than a tenth of it noise
};

/// The tool's own force, by position and direction:
///
///     f(x, closing)  = c(x) + m a,      f(x, opening) = o(x) + m a
///
/// with a the acceleration in the direction of closing. c and o are means over cycles of the mean of each
/// cycle's rows at a position, linear between `points` positions over the range of the strokes; m stands in
/// it only where it is determined, else it is zero. A wait counts half to the opening before it, half to the
/// closing after it. A hold, in which a hand presses a tool onto its end, is no force of the tool and counts
/// to neither.
struct ToolForce {
  std::vector<double> grid;  ///< positions that increase
  BlankBranch closing;
  BlankBranch opening;
  BlankInertia inertia;
  double closing_direction = 1.0;
  std::vector<std::uint32_t> used;  ///< numbers of the cycles
  std::vector<LeftOutCycle> left_out;
};

/// One of so many parts of the cycles: the (part + 1)-th of every `parts` cycles.
struct CyclePart {
  std::size_t part = 0;
  std::size_t parts = 0;  ///< two at least
};

/// Estimates it from the good cycles of a blank: those that `kerf inspect` flags with nothing, or only as
/// under force, which a blank is. Cycles are those that are stored in it along the axis and in the direction
/// that is asked for, else those that are found.
/// With a part left out the others are all that there are: how well a blank is known is told by leaving out
/// one part after the other.
/// @throws std::invalid_argument without measured force, or with fewer than two good cycles.
[[nodiscard]] ToolForce tool_force(const schema::Recording& blank, std::size_t axis, double closing_direction,
                                   const std::optional<CyclePart>& left_out = {});

/// The mean of the values of rows at each position of a uniform grid, of the rows nearest to it; linear
/// between the first and the last that has any; NaN beyond. Rows that are not finite do not count.
[[nodiscard]] std::vector<double> mean_by_position(std::span<const double> position,
                                                   std::span<const double> values,
                                                   std::span<const double> grid);

/// Acceleration along an axis from its position: second differences on the grid of the median period, after a
/// zero-phase low-pass of 20 Hz, or a fifth of the rate where that is less.
[[nodiscard]] std::vector<double> acceleration_of(const schema::Recording& recording, std::size_t axis);

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <vector>

#include <kerf/schema/recording.h>

#include "segment/branches.h"

namespace kerf::bench {

/// How the rows of a cycle are divided into phases.
struct DivisionOptions {
  double dwell = 0.05;   ///< share of a stroke at either end that counts as turning round
  double stroke = 0.05;  ///< share of the motion of all the rows that a stroke covers at least
};

/// Phases with one cycle made two: of the rows before `row`, and of those from it on. Either gets the phases
/// of its own motion: the closing is the largest rise that its rows hold, with the wait before it, the hold
/// and the opening after it. Cycles behind them count one more. The motion closes along the direction of
/// the cycles.
/// @throws std::invalid_argument in a line that names the cycle, if there is none, or the rows on either side
///         hold no closing.
[[nodiscard]] std::vector<schema::PhaseSpan> split_cycle(const AxisMotion& motion,
                                                         const std::vector<schema::PhaseSpan>& phases,
                                                         std::uint32_t cycle, std::uint64_t row,
                                                         const DivisionOptions& options);

/// Phases with a cycle and the next one made one, of the rows from the begin of the one to the end of the
/// other, by the same rule. Cycles behind them count one less. @throws std::invalid_argument likewise.
[[nodiscard]] std::vector<schema::PhaseSpan> merge_cycles(const AxisMotion& motion,
                                                          const std::vector<schema::PhaseSpan>& phases,
                                                          std::uint32_t cycle,
                                                          const DivisionOptions& options);

}  // namespace kerf::bench

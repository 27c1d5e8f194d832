#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kerf::bench {

/// The most rows whose times are finite and increase strictly, in order; of several such choices the one
/// that keeps the earlier rows. So a repeated stamp keeps its first row, and a single stamp that leaps ahead
/// costs that row, not all after it.
[[nodiscard]] std::vector<std::size_t> rows_in_order(std::span<const double> time_s);

/// The rows at which a clock starts anew: where the time falls back by more than half of what had gone by
/// since it last began, by the medians of the five finite rows before and after, and ten rows and more lie on
/// either side. A stamp that leaps ahead or back for a moment is none, nor is one that repeats.
[[nodiscard]] std::vector<std::size_t> clock_restarts(std::span<const double> time_s);

}  // namespace kerf::bench

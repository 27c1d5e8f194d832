#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kerf::bench {

/// The most rows whose times are finite and increase strictly, in order; of several such choices the one
/// that keeps the earlier rows. So a repeated stamp keeps its first row, and a single stamp that leaps ahead
/// costs that row, not all after it.
[[nodiscard]] std::vector<std::size_t> rows_in_order(std::span<const double> time_s);

}  // namespace kerf::bench

#pragma once

#include <vector>

#include "kerf/compare/align.h"

namespace kerf::compare {

/// Values of `got` at the times of some rows, on straight lines; `times` increase and lie within its own.
[[nodiscard]] Series at_times(const Series& got, const std::vector<double>& times);

/// By times, those of `got` less a lag. Over a gap of either no line is drawn: rows of the other that lie in
/// it are left out.
[[nodiscard]] Aligned by_time(const Series& expected, Series got, double lag_s);

}  // namespace kerf::compare

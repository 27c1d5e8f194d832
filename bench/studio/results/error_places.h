#pragma once

#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "recordings/axis_series.h"

namespace kerf::bench {

/// The stretches of a recording in which most of a law's squared error lies, the largest share first, six at
/// most: phases of its cycles along the axis that it was segmented on, else twentieths of its time. Rows
/// that do not count are in none.
///
///     from_s, to_s    of the stretch
///     cycle, phase    of which it is; not there for twentieths
///     rmse            in the stretch
///     share           of the squared error over all rows that count
[[nodiscard]] nlohmann::ordered_json error_places(const schema::Recording& recording, std::size_t axis,
                                                  const AxisSeries& series,
                                                  const std::vector<double>& residual);

}  // namespace kerf::bench

#include "chart/cost/timed_stretch.h"

#include <algorithm>
#include <cstddef>

namespace kerf::bench {

SampledMotion timed_stretch(const AxisSeries& series, double period_s) {
  constexpr std::size_t most_ticks = 4000;
  const std::size_t rows = series.time_s.size();
  const std::size_t length = std::min(rows, most_ticks);
  std::size_t inside = 0;
  std::size_t most = 0;
  std::size_t begin = 0;
  for (std::size_t end = 0; end < rows; ++end) {
    if (series.penetration[end] > 0.0) ++inside;
    if (end >= length && series.penetration[end - length] > 0.0) --inside;
    if (end + 1 < length || inside <= most) continue;
    most = inside;
    begin = end + 1 - length;
  }
  SampledMotion stretch = ticks_at(1.0 / period_s, length);
  for (std::size_t i = 0; i < length; ++i)
    stretch.sample[i] = {.position = {series.penetration[begin + i]},
                         .velocity = {series.velocity[begin + i]}};
  return stretch;
}

}  // namespace kerf::bench

#pragma once

#include <cstdint>

#include "segment/branches.h"

namespace kerf::bench {

/// A turning point of the motion.
struct Turn {
  std::uint64_t row = 0;
  double position = 0.0;
  bool closed = false;  ///< the most closed point between two openings, else the most open one
};

/// Where a stroke between two turns leaves the first and comes to the second, by `dwell` of its height.
struct StrokeRows {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

[[nodiscard]] StrokeRows stroke_between(const AxisMotion& motion, const Turn& from, const Turn& to,
                                        double dwell);

}  // namespace kerf::bench

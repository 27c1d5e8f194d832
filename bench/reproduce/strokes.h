#pragma once

#include <algorithm>

namespace kerf::bench {

/// A stroke of a hand: minimum jerk from rest to rest (Flash and Hogan 1985).
struct Stroke {
  double position = 0.0;
  double velocity = 0.0;
};
inline Stroke minimum_jerk(double time_s, double duration_s, double travel) {
  const double s = std::clamp(time_s / duration_s, 0.0, 1.0);
  return {.position = travel * s * s * s * (10.0 + s * (-15.0 + 6.0 * s)),
          .velocity = travel / duration_s * 30.0 * s * s * (1.0 - s) * (1.0 - s)};
}

}  // namespace kerf::bench

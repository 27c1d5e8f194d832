#pragma once

namespace kerf::fitting::segmented {

/// Weighted moments of points about their own mean: nothing large is ever subtracted from something large.
struct Moments {
  double weight = 0.0;
  double x = 0.0;  ///< mean
  double y = 0.0;  ///< mean
  double xx = 0.0, xy = 0.0, yy = 0.0;

  /// Joined with those of other points [Chan1983].
  void join(const Moments& other) noexcept {
    if (other.weight == 0.0) return;
    if (weight == 0.0) {
      *this = other;
      return;
    }
    const double both = weight + other.weight;
    const double share = other.weight / both;
    const double dx = other.x - x;
    const double dy = other.y - y;
    const double lever = weight * share;
    xx += other.xx + lever * dx * dx;
    xy += other.xy + lever * dx * dy;
    yy += other.yy + lever * dy * dy;
    x += share * dx;
    y += share * dy;
    weight = both;
  }
};

}  // namespace kerf::fitting::segmented

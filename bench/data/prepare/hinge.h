#pragma once

#include <span>

namespace kerf::bench {

/// A level that turns into a ramp: y = level + slope max(0, u - corner).
struct Hinge {
  double corner = 0.0;
  double level = 0.0;
  double slope = 0.0;
  double corner_error = 0.0;  ///< standard error, for noise that is white
  bool found = false;         ///< false if no rising ramp fits better than the level alone
};

/// The hinge of least squares through (u, y). The corner lies anywhere between the samples, not only at one:
/// for each gap between two of them, level and ramp are fitted apart, and their crossing is the corner if it
/// falls into that gap; else the best corner is at one of its ends. The exact minimum, in one pass.
/// Values u increase; a slope above zero is asked for. Five samples at least, else nothing is found.
[[nodiscard]] Hinge fit_hinge(std::span<const double> u, std::span<const double> y);

}  // namespace kerf::bench

#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <kerf/psychophysics/psychometric_fit.h>

namespace kerf::psychophysics {

inline constexpr std::size_t parameters = 4;

/// Threshold at the criterion on the axis of the curve, log of the slope, lapse rate, and the dispersion
/// theta = rho / (1 - rho).
using Point = std::array<double, parameters>;
enum : std::size_t { threshold_index, slope_index, lapse_index, dispersion_index };

struct Cell {
  double at = 0.0;  ///< intensity or its logarithm; minus infinity allowed
  Count answers;
};

/// A likelihood with bounds. Its axis is moved and scaled so that the levels span 0 to 1.
struct Problem {
  Shape shape = Shape::weibull;
  double guess = 0.5;
  double criterion = 0.75;
  std::vector<Cell> cells;
  Point lower{};
  Point upper{};
};

struct Score {
  double log_likelihood = 0.0;
  Point gradient{};
  std::array<Point, parameters> information{};
};

[[nodiscard]] double log_likelihood(const Problem& problem, const Point& point);
[[nodiscard]] Score score(const Problem& problem, const Point& point);

struct Maximum {
  Point at{};
  double log_likelihood = -HUGE_VAL;
};

/// Which parameters stay where they are.
using Held = std::array<bool, parameters>;

/// Fisher scoring with Levenberg's damping inside the bounds; the dispersion by its own second derivative.
[[nodiscard]] Maximum maximise(const Problem& problem, const Point& start, const Held& held);

/// The best from a grid of starts.
[[nodiscard]] Maximum maximise_from_many(const Problem& problem, const Point& like, const Held& held);

/// Standard coordinate of F at the criterion, for a lapse rate.
[[nodiscard]] double criterion_quantile(const Problem& problem, double lapse);

}  // namespace kerf::psychophysics

#pragma once

#include <string>
#include <vector>

#include "plot/colour_steps.h"
#include "plot/plot.h"

namespace kerf::bench {

/// A vertical axis, from 0 at its bottom to 1 at its top.
struct ParallelAxis {
  std::string label;  ///< with its unit
  std::vector<NamedTick> ticks;
};

/// One line across all axes.
struct ParallelLine {
  std::vector<double> at;  ///< on each axis; NaN: not known, which is drawn below the axis
  double value = 0.0;      ///< that gives its colour
  bool is_failed = false;  ///< dashed, in no colour of the scale
};

/// Parallel coordinates.
struct ParallelAxes {
  std::string title;
  std::vector<ParallelAxis> axes;
  std::vector<ParallelLine> lines;
  ColourSteps colours;
  int width_px = 900;
  int height_px = 420;
};

/// Draws it with gnuplot, as draw() does a chart.
[[nodiscard]] std::string draw(const ParallelAxes& axes);

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "plot/colour_steps.h"
#include "plot/plot.h"

namespace kerf::bench {

/// A tile of a heat map. What has no number has no colour either.
struct HeatTile {
  double value = std::numeric_limits<double>::quiet_NaN();
  bool is_there = true;      ///< any cell is behind it; else the ground is left bare
  bool has_failed = false;   ///< a cross: at least one cell
  bool has_missing = false;  ///< a ring: likewise
};

/// An axis whose parts are of one width, whatever their values.
struct HeatAxis {
  std::string label;  ///< with its unit
  std::size_t parts = 0;
  std::vector<NamedTick> ticks;  ///< 0.5 is the middle of the first part, 1 its end
};

/// One of several maps beside each other.
struct HeatPanel {
  std::string title;
  std::vector<HeatTile> tiles;  ///< along x first, from the bottom left
};

/// Heat maps of the same axes and colours beside and below each other, with their scale below.
struct HeatMap {
  std::string title;
  HeatAxis x;
  HeatAxis y;
  std::size_t across = 1;  ///< panels in a row
  std::vector<HeatPanel> panels;
  ColourSteps colours;
  std::vector<NamedTick> steps_named{};  ///< at bounds, in place of their numbers
  int width_px = 900;
};

/// Draws it with gnuplot, as draw() does a chart; numbers stand in the tiles where there is room for them.
[[nodiscard]] std::string draw(const HeatMap& map);

}  // namespace kerf::bench

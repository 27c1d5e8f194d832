#pragma once

#include "plot/plot.h"

namespace kerf::bench {

/// Gives the labels of a chart places where they cover neither each other nor marks, as far as there is room,
/// and sets their `text_x` and `text_y`.
///
/// One after the other takes, of some two hundred places about its point, the one that costs least: what it
/// covers, labels first, then marks, then lines, what its leader crosses, and how far it is. Sizes are those
/// of a small plot, 600 x 400 pixels, and of text of 14: in a larger one the same places are the looser.
/// Requires both ranges; labels of points outside them stay as they are.
void place_labels(Chart& chart);

}  // namespace kerf::bench

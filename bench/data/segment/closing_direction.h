#pragma once

#include <vector>

#include "segment/branches.h"
#include "segment/strokes.h"

namespace kerf::bench {

/// +1 or -1: the direction of the strokes that cost more work; where strokes either way differ by no more
/// than they do among each other, that into which the force grows, as it does into whatever is pressed.
[[nodiscard]] double direction_of_closing(const AxisMotion& motion, const std::vector<Turn>& turns);

}  // namespace kerf::bench

#pragma once

#include <vector>

#include <kerf/drivers/pose_path.h>

namespace kerf::bench {

// The two paths of a scalpel in [Henry2004], sections 5.1 and 5.2, of the hand 100 mm above the surface. The
// paper gives them as curves without numbers; lengths, angles and durations are chosen here, and are those of
// the shipped scenes scalpel-t1 and scalpel-t2.

/// 40 mm along -y, the direction in which the edge cuts, then 40 mm along x, across the blade, each in 0.8
/// s; 1.8 s in all.
[[nodiscard]] std::vector<drivers::PoseKeyframe> scalpel_t1();

/// A turn about the main axis of the blade, 60 deg there and back in a second each; 2.2 s in all.
[[nodiscard]] std::vector<drivers::PoseKeyframe> scalpel_t2();

}  // namespace kerf::bench

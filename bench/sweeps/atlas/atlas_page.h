#pragma once

#include <string>
#include <vector>

#include "atlas/pictures/atlas_picture.h"
#include "atlas/pictures/draw_picture.h"
#include "atlas/sweep_atlas.h"

namespace kerf::bench {

/// One self-contained page of a sweep: how many cells were computed, failed and are missing, what each column
/// holds, and pictures.
[[nodiscard]] std::string atlas_page(SweepAtlas& atlas, const std::vector<AtlasPicture>& pictures,
                                     const std::vector<DrawnPicture>& drawn);

}  // namespace kerf::bench

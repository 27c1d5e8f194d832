#pragma once

#include <string>

#include "atlas/pictures/atlas_picture.h"

namespace kerf::bench {

/// A picture, and what stands below it: how many cells are behind its tiles, and what of them has no number.
struct DrawnPicture {
  std::string svg;
  std::string caption;
};

/// Confidence of the intervals about shares, Clopper and Pearson's.
inline constexpr double confidence_of_shares = 0.999;

/// @throws std::invalid_argument in one line for what the sweep does not have; std::runtime_error as gnuplot.
[[nodiscard]] DrawnPicture draw_picture(SweepAtlas& atlas, const AtlasPicture& picture);

}  // namespace kerf::bench

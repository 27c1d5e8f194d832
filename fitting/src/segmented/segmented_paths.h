#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "segmented/segmented_line.h"

namespace kerf::fitting::segmented {

/// A path to a knot: knots behind it, and the least squared error of all points before it, as a function of
/// the forces y at it, one a branch: least + sum of curvature (y - best)^2.
struct Path {
  std::array<double, 2> curvature{};
  std::array<double, 2> best{};
  double least = 0.0;
  std::uint32_t place = 0;   ///< of the knot before
  std::uint32_t parent = 0;  ///< which of the paths there
};

/// The path prolonged by one segment, its forces at the knot before eliminated.
[[nodiscard]] inline Path prolonged(const Path& path, const Line* lines, std::size_t branches) noexcept {
  Path longer;
  longer.least = path.least;
  for (std::size_t branch = 0; branch < branches; ++branch) {
    const Line& line = lines[branch];
    const double a = path.curvature[branch];
    const double miss = path.best[branch] - line.p0;
    const double scaled = line.far * a + line.determinant;  // the new curvature times (near + a)
    const double both = line.near + a;
    longer.least += line.error;
    longer.best[branch] = line.q0;
    if (scaled > 0.0 && both > 0.0) {
      longer.curvature[branch] = scaled / both;
      longer.best[branch] -= line.cross * a * miss / scaled;
      longer.least += a * miss * miss * (line.determinant / scaled);
    } else {
      longer.curvature[branch] = both > 0.0 ? 0.0 : line.far;
    }
  }
  return longer;
}

/// Keeps, in the order of their least errors, the paths that are somewhere the best of all and below the
/// ceiling. One branch: exactly those, the lower envelope of the parabolas, if there are not more than
/// `most`. Returns through `lost` the least error of those that only that limit removed, or infinity. May
/// leave the given paths in another order, and fewer of them.
[[nodiscard]] std::vector<Path> lower_envelope(std::vector<Path>& paths, double ceiling, std::size_t most,
                                               double& lost);

/// Two branches: those that no other one beats wherever they are below the ceiling, at most `most`. Returns
/// through `lost` the least error of those that only that limit removed, or infinity.
[[nodiscard]] std::vector<Path> undominated(const std::vector<Path>& paths, double ceiling, std::size_t most,
                                            double& lost);

}  // namespace kerf::fitting::segmented

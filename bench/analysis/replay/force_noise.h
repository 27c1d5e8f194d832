#pragma once

#include <span>

namespace kerf::bench {

/// Standard deviation of white noise upon a smooth force, robustly from second differences: they hold noise
/// of six times its variance, and next to nothing of what a cut does between two samples. A rupture is a few
/// differences among many.
///
/// A sensor that is slower than its rows, whose values are held or drawn out on straight lines, shows its
/// noise only where a value is new: there the differences are taken. Of a force of coarse steps most
/// differences are zero; its noise is that of the rows as a whole, and that of the quantum q besides, q /
/// sqrt(12).
[[nodiscard]] double noise_of(std::span<const double> force);

}  // namespace kerf::bench

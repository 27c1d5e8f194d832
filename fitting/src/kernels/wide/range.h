#pragma once

#include <span>

namespace kerf::fitting::wide {

/// Of a column, in one pass.
struct Range {
  double least, most;
  bool is_finite;  ///< all of it; else the others say nothing
};
/// @param values at least one
[[nodiscard]] Range range_of(std::span<const double> values) noexcept;

}  // namespace kerf::fitting::wide

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "atlas/atlas_answer.h"
#include "plot/heat_map.h"

namespace kerf::bench {

/// Three digits, as short as they are.
[[nodiscard]] std::string short_number(double value);
/// The value of a part of a listed axis.
[[nodiscard]] std::string name_of_part(const AtlasAxis& axis, std::size_t part);
/// An axis with as many names as fit: along x in a panel of so many pixels, along y (0) about ten.
[[nodiscard]] HeatAxis heat_axis(const AtlasAxis& axis, std::size_t width_px);

/// Where the values of a sample stand on one of several parallel axes: from 0 to 1, listed ones at equal
/// distances.
class AtlasScale {
 public:
  AtlasScale(const AtlasColumn& column, double smallest, double largest);
  [[nodiscard]] double place(double value) const;  ///< NaN of NaN
  [[nodiscard]] std::vector<NamedTick> ticks() const;

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  double smallest_;
  double largest_;
  bool logarithmic_ = false;
};
[[nodiscard]] AtlasScale scale_of(const AtlasColumn& column, const std::vector<double>& numbers);

}  // namespace kerf::bench

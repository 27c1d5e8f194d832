#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "laws/law_file.h"

namespace kerf::bench {

/// Force over penetration for a tool that goes in at a constant speed and comes out again at the same, the
/// whole way in a second: a quick picture of a law along one axis, without its rendering aids.
struct LawCurve {
  std::vector<double> penetration;  ///< [m or rad]
  std::vector<double> closing;      ///< on the way in
  std::vector<double> opening;      ///< on the way out, at the same penetrations
  double speed = 0.0;               ///< [m/s or rad/s]
  std::string range;                ///< in words, what ends it
};

/// To where the law itself ends (the last knot or grid point, the depth its parameters speak of), else to
/// 10 mm or 0.5 rad. Empty for a law on several axes.
[[nodiscard]] LawCurve curve_of(const LawFile& law);

/// A law as a page shows it: what it is, its parameters with units, its file's text and its curve.
[[nodiscard]] nlohmann::ordered_json law_as_json(const LawFile& law, const std::string& name);

}  // namespace kerf::bench

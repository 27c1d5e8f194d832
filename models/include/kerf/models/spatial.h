#pragma once

#include <string>
#include <vector>

namespace kerf::models {

/// An axis that a spatial law acts on. Laws and devices find each other by name and units.
struct LawAxis {
  std::string name;           ///< "x", "rx", "theta", "q1", ... as drivers/README.md has them
  std::string position_unit;  ///< "m" or "rad"
  std::string force_unit;     ///< "N" or "N·m"
};

}  // namespace kerf::models

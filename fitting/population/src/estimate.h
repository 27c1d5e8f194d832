#pragma once

#include <span>

#include <kerf/population/group.h>

namespace kerf::population {

struct Wanted {
  double confidence = 0.95;
  bool has_limits = false;  ///< also limits of the spreads and of the next specimen
  std::span<const Shared> shared{};
};

/// `estimate_group`, or what of it is quick.
[[nodiscard]] GroupEstimate estimate(std::span<const Estimate> estimates, const Wanted& wanted);

}  // namespace kerf::population

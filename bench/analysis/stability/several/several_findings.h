#pragma once

#include <nlohmann/json.hpp>

#include "plot/plot.h"
#include "stability/findings.h"
#include "stability/several/several_device.h"

namespace kerf::bench {

[[nodiscard]] Findings findings_of(const DirectionMap& map, const StudiedAxis& on);

/// The picture of what findings_of() wrote: stiffness as the distance from the middle, in the direction of
/// the wall; where it differs by more than ten times, its logarithm.
/// @throws nlohmann::json::exception if it lacks what such a study has.
[[nodiscard]] Chart direction_picture(const nlohmann::ordered_json& study);

}  // namespace kerf::bench

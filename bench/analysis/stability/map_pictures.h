#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "plot/plot.h"
#include "stability/device/travel_units.h"
#include "stability/maps.h"

namespace kerf::bench {

/// Walls: damping to the right, stiffness up, with the boundaries as lines.
[[nodiscard]] Chart picture_of(const WallMap& map, const TravelUnits& units = {});
/// A law: depth to the right, rate up, with where its local stiffness is too much as a line.
[[nodiscard]] Chart picture_of(const std::string& model, const LawMap& map, const TravelUnits& units = {});

/// The same of what findings_of() wrote, its cells in the same order, and for a page the device's own damping
/// or the depth that was asked for as a line. Nothing for a study without cells.
/// @throws nlohmann::json::exception if it lacks what a map has; std::invalid_argument if its cells are no
/// grid.
[[nodiscard]] std::optional<Chart> map_picture(const nlohmann::ordered_json& study);

}  // namespace kerf::bench

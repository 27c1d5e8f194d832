#pragma once

#include <nlohmann/json.hpp>

#include "plot/plot.h"
#include "stability/controllers/compare_controllers.h"
#include "stability/findings.h"

namespace kerf::bench {

/// One table: each controller at each damping, with its transparency and what a tick of it costs.
[[nodiscard]] Findings findings_of(const ComparedControllers& compared, const StudiedAxis& on);

/// The picture of what findings_of() wrote: how far from the wall over how stiff, a point a controller.
/// @throws nlohmann::json::exception if it lacks what such a study has.
[[nodiscard]] Chart controllers_picture(const nlohmann::ordered_json& study);

}  // namespace kerf::bench

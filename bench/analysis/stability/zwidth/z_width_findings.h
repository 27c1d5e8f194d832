#pragma once

#include <nlohmann/json.hpp>

#include "plot/plot.h"
#include "stability/findings.h"
#include "stability/zwidth/z_width.h"

namespace kerf::bench {

/// What was measured beside theory; without a model, alone.
[[nodiscard]] Findings findings_of(const ZWidth& measured, const std::vector<ZWidthTheory>& theory,
                                   const std::optional<UncertainModel>& model, const StudiedAxis& on);

/// The picture of what findings_of() wrote. @throws nlohmann::json::exception if it lacks what such a study
/// has.
[[nodiscard]] Chart z_width_picture(const nlohmann::ordered_json& study);

}  // namespace kerf::bench

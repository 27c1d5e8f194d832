#pragma once

#include <string>

#include "atlas/atlas_answer.h"
#include "atlas/sweep_atlas.h"

namespace kerf::bench {

/// A sweep as the page has it: api/sweeps.ts names every key.
[[nodiscard]] std::string sweep_json(SweepAtlas& atlas);
[[nodiscard]] std::string answer_json(const AtlasAnswer& answer);
[[nodiscard]] std::string sample_json(const AtlasSample& sample);

}  // namespace kerf::bench

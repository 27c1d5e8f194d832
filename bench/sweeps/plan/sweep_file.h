#pragma once

#include <filesystem>

#include "plan/sweep_plan.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {

/// Reads what a person wrote of a sweep: SWEEP.toml, docs/sweeps.md. Its shards are 0 where it names none.
/// @throws std::invalid_argument with file and line.
[[nodiscard]] SweepPlan read_sweep(const std::filesystem::path& file, SweepVerbs verbs = sweep_verbs());

}  // namespace kerf::bench

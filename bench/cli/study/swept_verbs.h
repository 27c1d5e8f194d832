#pragma once

#include "verbs/sweep_verb.h"

namespace kerf::bench {

/// `kerf session simulate`. It stands here because the rooms of sweeps and of sessions do not see each other.
extern const SweepVerb sweep_of_simulations;

/// Every verb that a sweep may name: those of its room, and those of rooms beside it.
[[nodiscard]] SweepVerbs swept_verbs();

}  // namespace kerf::bench

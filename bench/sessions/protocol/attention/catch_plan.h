#pragma once

#include <cstdint>
#include <vector>

#include "protocol/plan.h"

namespace kerf::bench {

/// Puts the catch trials of the protocol into the plans of all subjects. Of each `every` trials that count
/// one has a catch trial after it, which one by chance: none is the first of a session, and no two follow
/// each other. It is of the tissue of the trial before. The ways of filling the slots come equally often for
/// each subject, within one, and what is left over evens out over subjects; so do the pairs. All other trials
/// stay as they are.
void add_catch_trials(const Protocol& protocol, std::uint64_t seed, std::vector<Plan>& plans);

}  // namespace kerf::bench

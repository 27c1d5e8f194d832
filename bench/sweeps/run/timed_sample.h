#pragma once

#include <atomic>
#include <filesystem>

#include "plan/plan_file.h"
#include "run/sweep_worker.h"

namespace kerf::bench {

/// Computes some cells that lie evenly over a plan, in one worker, until there are enough or it has taken
/// long enough, and says what the others will take. None where not even one came to an end.
/// @throws std::system_error if no worker begins, or it was stopped.
[[nodiscard]] ExpectedCost timed_sample(const PlanFile& plan, const WorkerProgram& program,
                                        const std::atomic<bool>& stop);

/// Shards of half an hour of one processor each, as far as that is known: from 1 to 1,000.
[[nodiscard]] std::uint64_t shards_for(const ExpectedCost& cost, std::uint64_t cells);

}  // namespace kerf::bench

#include "merge/sweep_status.h"

#include <algorithm>
#include <set>

namespace kerf::bench {

std::string SweepStatus::left() const {
  std::vector<std::uint64_t> all = begun;
  all.insert(all.end(), not_begun.begin(), not_begun.end());
  std::ranges::sort(all);
  return as_ranges(all);
}

SweepStatus status_of(const PlanFile& plan, const GatheredCells& cells) {
  SweepStatus status{.cells = cells.cells(), .computed = cells.computed(), .failed = cells.failed()};
  std::set<std::uint64_t> divisions;
  for (const FoundShard& shard : cells.shards()) divisions.insert(shard.content.name.shards);
  status.several_divisions = divisions.size() > 1;
  const bool planned = divisions.empty() || divisions.contains(plan.plan.shards);
  status.shards = planned ? plan.plan.shards : *divisions.begin();
  std::set<std::uint64_t> seen;
  for (const FoundShard& shard : cells.shards()) {
    if (shard.content.name.shards != status.shards) continue;
    seen.insert(shard.content.name.shard);
    (shard.complete ? status.complete : status.begun).push_back(shard.content.name.shard);
  }
  for (std::uint64_t shard = 0; shard < status.shards; ++shard)
    if (!seen.contains(shard)) status.not_begun.push_back(shard);
  std::ranges::sort(status.complete);
  std::ranges::sort(status.begun);
  return status;
}

nlohmann::ordered_json as_json(const SweepStatus& status) {
  return {{"cells", status.cells},   {"computed", status.computed},
          {"failed", status.failed}, {"missing", status.cells - status.computed - status.failed},
          {"shards", status.shards}, {"complete", status.complete},
          {"begun", status.begun},   {"not_begun", status.not_begun},
          {"left", status.left()}};
}

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "merge/gathered_cells.h"

namespace kerf::bench {

/// How far a sweep is, by what its shards say.
struct SweepStatus {
  std::uint64_t cells = 0;
  std::uint64_t computed = 0;
  std::uint64_t failed = 0;
  std::uint64_t shards = 1;  ///< of those that were begun; else as planned
  std::vector<std::uint64_t> complete;
  std::vector<std::uint64_t> begun;  ///< and not complete
  std::vector<std::uint64_t> not_begun;
  bool several_divisions = false;  ///< shards of several numbers of shards are there

  /// Shards to be run, as `--array` takes them.
  [[nodiscard]] std::string left() const;
};

[[nodiscard]] SweepStatus status_of(const PlanFile& plan, const GatheredCells& cells);
[[nodiscard]] nlohmann::ordered_json as_json(const SweepStatus& status);

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "plan/sweep_plan.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {

/// What a timed sample of cells says of the others.
struct ExpectedCost {
  std::uint64_t timed = 0;          ///< cells
  std::uint64_t failed = 0;         ///< of them
  double cell_s = 0.0;              ///< mean time of a cell in a worker
  double longest_s = 0.0;           ///< of those timed
  double begin_s = 0.0;             ///< until a worker is ready
  std::uintmax_t worker_bytes = 0;  ///< largest that it was in memory

  /// Of one processor [s].
  [[nodiscard]] double whole_s(std::uint64_t cells) const noexcept {
    return cell_s * static_cast<double>(cells);
  }
};

/// A plan as it is written: NAME.plan.json.
struct PlanFile {
  SweepPlan plan;
  std::string sha256;  ///< SweepPlan::sha256()
  std::filesystem::path file;

  /// Where its shards are: NAME.shards beside it.
  [[nodiscard]] std::filesystem::path shards_folder() const;
};

inline constexpr std::string_view plan_ending = ".plan.json";

/// Names of files are kept as from the folder of `file`.
/// @throws as write_json_file() does.
void write_plan(const std::filesystem::path& file, const SweepPlan& plan,
                const std::optional<ExpectedCost>& cost, bool replace);

/// @throws std::invalid_argument in one line: no plan, one of another version, or one that was changed after
///         it was written.
[[nodiscard]] PlanFile read_plan(const std::filesystem::path& file, SweepVerbs verbs = sweep_verbs());

/// What SweepPlan::as_json() says of a plan, which a merged sweep keeps: no shards and no limits.
/// @throws nlohmann::json::exception, std::invalid_argument for what it does not say.
[[nodiscard]] SweepPlan plan_from_json(const nlohmann::ordered_json& what,
                                       const std::filesystem::path& folder, SweepVerbs verbs);

/// That the files of some cells are what they were when the sweep was planned: each is hashed once.
/// @throws std::invalid_argument that names the first that is missing or another one.
void require_planned_files(const SweepPlan& plan, const ShardRange& range);

}  // namespace kerf::bench

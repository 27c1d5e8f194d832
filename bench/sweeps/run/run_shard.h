#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "plan/plan_file.h"
#include "run/shard_file.h"
#include "run/shard_lock.h"
#include "run/sweep_worker.h"

namespace kerf::bench {

/// How far a shard is.
struct ShardProgress {
  std::uint64_t cells = 0;
  std::uint64_t done = 0;  ///< failed ones too
  std::uint64_t failed = 0;
  std::uint64_t computed = 0;  ///< by this run
  double elapsed_s = 0.0;      ///< of this run

  /// By how fast this run was so far [s]; NaN: not known.
  [[nodiscard]] double left_s() const noexcept;
};

struct ShardRunOptions {
  ShardName name;
  std::filesystem::path folder;  ///< of the shards; it is made
  std::size_t workers = 1;
  WorkerProgram worker;
  bool failed_again = false;  ///< cells that failed before are computed once more
  ShardLock::Options lock;
  std::chrono::milliseconds synchronise_every{5000};
  std::function<void(const ShardProgress&)> progress = [](const ShardProgress&) {};  ///< told now and then
};

struct ShardOutcome {
  ShardProgress progress;
  bool complete = false;  ///< else it was stopped, and goes on where it is run again
  double cells_s = 0.0;   ///< processor time in the cells that this run computed
  std::filesystem::path file;
};

/// Computes what is missing of a shard: cells that stand in its file already are left as they are, and a
/// shard that is complete is only looked at. Every cell is computed by a worker. One that ends its worker is
/// given to another one; if it ends that too, or takes too long, that is what came of it. After `stop` the
/// cells that are underway are dropped, and what is done is on the disk.
/// @throws std::invalid_argument: no such shard, another plan, recordings that are not what they were, or
///         somebody else computes it; std::system_error (the disk, workers that do not start).
ShardOutcome run_shard(const PlanFile& plan, const ShardRunOptions& options, const std::atomic<bool>& stop);

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "plan/plan_file.h"

namespace kerf::bench {

/// What runs the shards of a sweep.
enum class SweepEngine : std::uint8_t { slurm, parallel, snakemake };
/// "slurm", "parallel" or "snakemake". @throws std::invalid_argument
[[nodiscard]] SweepEngine sweep_engine_called(const std::string& name);

struct SubmitOptions {
  SweepEngine engine = SweepEngine::slurm;
  std::string program = "kerf";  ///< as the machines call it
  std::filesystem::path shards;  ///< folder of the shards
  std::uint64_t at_once = 0;     ///< shards; 0: as many as there are places
  std::string hosts;             ///< of parallel: its list for --sshlogin; empty: this machine
  std::string only;              ///< "3,7,12-14": these shards alone; empty: all
  double hours = 2.0;            ///< of a shard, as the queue is told
};

/// A script that gives the shards of a plan to an engine. It holds all that the engine needs, and no state.
struct SweepScript {
  std::string name;  ///< of its file: "noise.sbatch"
  std::string text;
  std::string command;  ///< how it is started
};
/// @throws std::invalid_argument for what the engine has not.
[[nodiscard]] SweepScript sweep_script(const PlanFile& plan, const SubmitOptions& options);

}  // namespace kerf::bench

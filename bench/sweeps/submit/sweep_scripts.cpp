#include "submit/sweep_scripts.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "run/shard_file.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// As a word of a shell.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string stem_of(const PlanFile& plan) {
  std::string name = plan.file.filename().string();
  return name.substr(0, name.find('.'));
}

std::string run_command(const PlanFile& plan, const SubmitOptions& options, const std::string& shard) {
  return fmt::format("{} sweep run {} --shard {}/{} -j 1 -o {}", quoted(options.program),
                     quoted(plan.file.string()), shard, plan.plan.shards, quoted(options.shards.string()));
}

/// Megabytes of a shard: its worker, and the process that writes.
std::size_t megabytes_of(const PlanFile& plan) { return plan.plan.limits.megabytes + 300; }

SweepScript slurm_script(const PlanFile& plan, const SubmitOptions& options) {
  const std::string all = fmt::format("0-{}", plan.plan.shards - 1);
  const std::string which = options.only.empty() ? all : options.only;
  const std::string at_once = options.at_once > 0 ? fmt::format("%{}", options.at_once) : "";
  const auto minutes = static_cast<long>(std::ceil(60.0 * options.hours));
  const std::string name = stem_of(plan) + ".sbatch";
  std::string text = "#!/bin/bash\n";
  text +=
      fmt::format("# The shards of {}, one a task; plan {}.\n", plan.file.filename().string(), plan.sha256);
  text += fmt::format("#SBATCH --job-name={}\n", stem_of(plan));
  text += fmt::format("#SBATCH --array={}{}\n", which, at_once);
  text += "#SBATCH --cpus-per-task=1\n";
  text += fmt::format("#SBATCH --mem={}M\n", megabytes_of(plan));
  text += fmt::format("#SBATCH --time={}\n", minutes);
  text += "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --signal=B:USR1@120\n";
  text += fmt::format("#SBATCH --output={}/slurm-%A_%a.out\n", options.shards.string());
  text +=
      "\n# Slurm's signals reach this shell, which hands them on. A shard that was stopped ends with 75 and "
      "goes\n"
      "# on where the same task is run again: here by asking for it; a site may list 75 in RequeueExit "
      "instead.\n";
  text += "trap 'stopped=yes; [ -z \"$shard\" ] || kill -USR1 $shard' USR1 TERM\n";
  text += run_command(plan, options, "\"$SLURM_ARRAY_TASK_ID\"") + " &\n";
  text +=
      "shard=$!\n"
      "[ -z \"$stopped\" ] || kill -USR1 $shard  # it came before there was a shard to tell\n"
      "wait $shard; status=$?\n"
      "while kill -0 $shard 2>/dev/null; do wait $shard; status=$?; done\n"
      "[ $status -ne 75 ] || scontrol requeue \"${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}\"\n"
      "exit $status\n";
  std::string command = "sbatch " + name;
  if (plan.plan.shards > 1001) command += "   # MaxArraySize is 1001 unless the site says otherwise";
  return {.name = name, .text = text, .command = command};
}

/// Numbers of "3,7,12-14", a word each, as parallel takes them.
std::string listed_shards(const PlanFile& plan, const SubmitOptions& options) {
  if (options.only.empty()) return fmt::format("$(seq 0 {})", plan.plan.shards - 1);
  std::string words;
  for (std::size_t begin = 0; begin < options.only.size();) {
    const std::size_t end = std::min(options.only.find(',', begin), options.only.size());
    const std::string part = options.only.substr(begin, end - begin);
    const auto dash = part.find('-');
    words += words.empty() ? "" : " ";
    words += dash == std::string::npos
                 ? part
                 : fmt::format("$(seq {} {})", part.substr(0, dash), part.substr(dash + 1));
    begin = end + 1;
  }
  return words;
}

SweepScript parallel_script(const PlanFile& plan, const SubmitOptions& options) {
  const std::string name = stem_of(plan) + ".parallel.sh";
  const std::string log = (options.shards / "joblog").string();
  std::string text = "#!/bin/bash\n";
  text +=
      fmt::format("# The shards of {}; plan {}. Run again, it goes on with those that are not complete.\n",
                  plan.file.filename().string(), plan.sha256);
  text += fmt::format("mkdir -p {}\n", quoted(options.shards.string()));
  text += fmt::format("exec parallel --joblog {} --resume-failed --termseq TERM,2000,KILL,25", quoted(log));
  if (options.at_once > 0) text += fmt::format(" --jobs {}", options.at_once);
  if (!options.hosts.empty()) text += fmt::format(" --sshlogin {}", quoted(options.hosts));
  // The command is one word, which parallel gives to a shell on each host.
  text += fmt::format(" \\\n  {} \\\n  ::: {}\n", quoted(run_command(plan, options, "{}")),
                      listed_shards(plan, options));
  return {.name = name, .text = text, .command = "bash " + name};
}

SweepScript snakemake_script(const PlanFile& plan, const SubmitOptions& options) {
  if (!options.only.empty())
    throw std::invalid_argument("--only: Snakemake finds out itself which shards are missing; leave it out");
  const std::string name = stem_of(plan) + ".smk";
  const std::uint64_t shards = plan.plan.shards;
  const bool folders = shards > 1000;
  std::string text =
      fmt::format("# The shards of {}; plan {}.\n", plan.file.filename().string(), plan.sha256);
  text +=
      "# A shard that is not complete is NAME.shard.partial, which Snakemake does not know and leaves where "
      "it is:\n"
      "# run again, the shard goes on from there.\n";
  text += fmt::format("SHARDS = {}\nFOLDER = {:?}\nPLAN = {:?}\nKERF = {:?}\n\n\n", shards,
                      options.shards.string(), plan.file.string(), options.program);
  const std::string one =
      folders ? "{FOLDER}/{int(i) // 1000}/{i}-of-{SHARDS}.shard" : "{FOLDER}/{i}-of-{SHARDS}.shard";
  text += "rule all:\n    input:\n";
  text += fmt::format("        [f\"{}\" for i in range(SHARDS)],\n\n\n", one);
  text += "rule shard:\n    output:\n";
  text += folders ? "        FOLDER + \"/{thousand}/{i}-of-\" + str(SHARDS) + \".shard\",\n"
                  : "        FOLDER + \"/{i}-of-\" + str(SHARDS) + \".shard\",\n";
  text += "    wildcard_constraints:\n        i=\"[0-9]+\",\n";
  if (folders) text += "        thousand=\"[0-9]+\",\n";
  text += fmt::format("    threads: 1\n    resources:\n        mem_mb={},\n", megabytes_of(plan));
  text +=
      "    shell:\n"
      "        \"{KERF:q} sweep run {PLAN:q} --shard {wildcards.i}/{SHARDS} -j 1 -o {FOLDER:q} || [ $? -eq 1 "
      "]\"\n";
  const std::string cores = options.at_once > 0 ? std::to_string(options.at_once) : "all";
  return {.name = name,
          .text = text,
          .command = fmt::format("snakemake -s {} --cores {} --rerun-incomplete --rerun-triggers mtime", name,
                                 cores)};
}

}  // namespace

SweepEngine sweep_engine_called(const std::string& name) {
  if (name == "slurm") return SweepEngine::slurm;
  if (name == "parallel") return SweepEngine::parallel;
  if (name == "snakemake") return SweepEngine::snakemake;
  throw std::invalid_argument(fmt::format("'{}' is not slurm, parallel or snakemake", name));
}

SweepScript sweep_script(const PlanFile& plan, const SubmitOptions& options) {
  if (!options.hosts.empty() && options.engine != SweepEngine::parallel)
    throw std::invalid_argument("--hosts is of GNU parallel; Slurm and Snakemake know their machines");
  if (options.only.find_first_not_of("0123456789,-") != std::string::npos)
    throw std::invalid_argument(
        fmt::format("--only: '{}' is no list of shards, such as 3,7,12-14", options.only));
  switch (options.engine) {
    case SweepEngine::slurm:
      return slurm_script(plan, options);
    case SweepEngine::parallel:
      return parallel_script(plan, options);
    case SweepEngine::snakemake:
      return snakemake_script(plan, options);
  }
  throw std::invalid_argument("no engine");
}

}  // namespace kerf::bench

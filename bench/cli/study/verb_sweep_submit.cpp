#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "plan/plan_file.h"
#include "study/swept_verbs.h"
#include "study/verb_sweep.h"
#include "submit/sweep_scripts.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct SweepSubmitArguments {
  std::string plan;
  std::string engine;
  std::string shards;
  std::string output;
  SubmitOptions options;
  std::size_t at_once = 0;
  bool dry_run = false;
  bool force = false;
};

void run_sweep_submit(const SweepSubmitArguments& arguments, Context& context) {
  const PlanFile plan = read_plan(arguments.plan, swept_verbs());
  SubmitOptions options = arguments.options;
  options.engine = sweep_engine_called(arguments.engine);
  options.at_once = arguments.at_once;
  options.shards = arguments.shards.empty() ? plan.shards_folder() : fs::absolute(arguments.shards);
  const SweepScript script = sweep_script(plan, options);
  context.result = {{"engine", arguments.engine}, {"script", script.text}, {"command", script.command}};
  if (arguments.dry_run) {
    context.say(script.text);
    context.say("# " + script.command);
    return;
  }
  const fs::path file =
      arguments.output.empty() ? plan.file.parent_path() / script.name : fs::path(arguments.output);
  require_output(file, arguments.force);
  fs::create_directories(options.shards);  // where Slurm writes what a task prints
  write_whole_file(file, script.text, schema::existing_if(arguments.force));
  context.result["file"] = file.string();
  context.say(fmt::format("{} is written; start it with\n  {}", file.string(), script.command));
}

}  // namespace

void add_sweep_submit(CLI::App& sweep, Context& context) {
  auto arguments = std::make_shared<SweepSubmitArguments>();
  Verb verb = add_verb(sweep, context, "submit",
                       "Write the script by which Slurm, GNU parallel or Snakemake run a sweep",
                       "kerf sweep submit noise.plan.json --engine slurm --dry-run\n"
                       "  kerf sweep submit noise.plan.json --engine parallel --hosts :,node7\n\n"
                       "The engine itself is started by you: the last line says how.",
                       [arguments, &context] { run_sweep_submit(*arguments, context); });
  verb.add_option("PLAN", arguments->plan, "NAME.plan.json of 'kerf sweep plan'").required();
  verb.add_option("--engine", arguments->engine, "What runs the shards")
      .one_of({"slurm", "parallel", "snakemake"})
      .required();
  verb.add_flag("--dry-run", arguments->dry_run, "Print the script, and write nothing");
  verb.add_option("--program", arguments->options.program, "kerf, as the machines call it").with_default();
  verb.add_option("--folder", arguments->shards,
                  "Folder of the shards (default: NAME.shards beside the plan)");
  verb.add_option("--at-once", arguments->at_once, "Shards at a time (default: as many as there are places)")
      .within(1, 1'000'000);
  verb.add_option("--hours", arguments->options.hours, "Time that a shard may take in the queue of Slurm [h]")
      .within(0.02, 10000.0)
      .with_default();
  verb.add_option("--hosts", arguments->options.hosts,
                  "Hosts of GNU parallel as its --sshlogin takes them: :,node7");
  verb.add_option("--only", arguments->options.only,
                  "These shards alone, as 'kerf sweep status' lists them: 3,7,12-14");
  verb.add_option("-o,--output", arguments->output, "The script (default: beside the plan)");
  verb.add_flag("--force", arguments->force, "Replace a script that is there");
}

}  // namespace kerf::bench

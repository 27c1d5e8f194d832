#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "merge/merge_sweep.h"
#include "merge/sweep_status.h"
#include "program/progress.h"
#include "study/swept_verbs.h"
#include "study/verb_sweep.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct SweepMergeArguments {
  std::string plan;
  std::string shards;
  std::string output;
  bool force = false;

  [[nodiscard]] fs::path shards_of(const PlanFile& read) const {
    return shards.empty() ? read.shards_folder() : fs::path(shards);
  }
};

void say_status(const SweepStatus& status, Context& context) {
  context.say(fmt::format("{} of {} cells are there, {} of them failed", status.computed + status.failed,
                          status.cells, status.failed));
  context.say(fmt::format("{} of {} shards are complete, {} begun", status.complete.size(), status.shards,
                          status.begun.size()));
  if (status.several_divisions)
    context.say(fmt::format("shards of other numbers of shards than {} are there too; their cells count",
                            status.shards));
}

void run_sweep_status(const SweepMergeArguments& arguments, Context& context) {
  const PlanFile plan = read_plan(arguments.plan, swept_verbs());
  const GatheredCells cells(plan, arguments.shards_of(plan));
  const SweepStatus status = status_of(plan, cells);
  context.result = as_json(status);
  context.result["held"] = nlohmann::ordered_json::array();
  say_status(status, context);
  for (const FoundShard& shard : cells.shards()) {
    if (shard.holder.host.empty()) continue;
    context.say(fmt::format("  {}: {}", shard.content.name.in_words(), shard.holder.in_words()));
    context.result["held"].push_back({{"shard", shard.content.name.shard},
                                      {"host", shard.holder.host},
                                      {"process", shard.holder.process}});
  }
  if (cells.missing() > 0 && !status.left().empty())
    context.say(fmt::format("to be run: --array={}", status.left()));
  if (cells.missing() > 0 || cells.failed() > 0) context.exit = Exit::check_failed;
}

void say_merged(const GatheredCells& cells, const SweepStatus& status, const fs::path& folder,
                Context& context) {
  context.result = as_json(status);
  context.result["folder"] = folder.string();
  context.result["software"] = cells.software();
  context.result["different"] = cells.different().size();
  say_status(status, context);
  if (cells.software().size() > 1)
    context.say(fmt::format("{} versions of the program computed them", cells.software().size()));
  if (!cells.different().empty())
    context.say(fmt::format("{} cells were computed twice, to other numbers, by {:.2g} of themselves at most",
                            cells.different().size(), cells.largest_difference()));
  if (cells.missing() > 0)
    context.say("missing.csv names the cells that are missing, 'kerf sweep status' the shards");
  if (cells.failed() > 0)
    context.say("failed.csv says of each cell that failed why; 'kerf sweep run --failed' tries again");
  constexpr double alike = 1e-9;  // as processors of two kinds may differ
  if (cells.missing() > 0 || cells.failed() > 0 || cells.largest_difference() > alike)
    context.exit = Exit::check_failed;
  context.say(
      fmt::format("sweep.h5, a CSV table of each kind of cell, and columns.csv are in {}", folder.string()));
}

void run_sweep_merge(const SweepMergeArguments& arguments, Context& context) {
  const PlanFile plan = read_plan(arguments.plan, swept_verbs());
  fs::path folder = arguments.output;
  if (folder.empty()) folder = plan.shards_folder().replace_extension(".merged");
  require_output(folder / "sweep.h5", arguments.force);
  const GatheredCells cells(plan, arguments.shards_of(plan));
  {
    WholeFolder whole(folder, schema::existing_if(arguments.force));
    Progress progress(fmt::format("merging {} cells", cells.cells()), cells.cells());
    write_merged(plan, cells, whole.path(), progress.done);
    whole.commit();
  }
  say_merged(cells, status_of(plan, cells), folder, context);
}

void add_sweep_plan_file(Verb& verb, SweepMergeArguments& arguments) {
  verb.add_option("PLAN", arguments.plan, "NAME.plan.json of 'kerf sweep plan'").required();
  verb.add_option("--folder", arguments.shards,
                  "Folder of the shards (default: NAME.shards beside the plan)");
}

}  // namespace

void add_sweep_status(CLI::App& sweep, Context& context) {
  auto arguments = std::make_shared<SweepMergeArguments>();
  Verb verb = add_verb(sweep, context, "status", "How far a sweep is, who computes what, and what is left",
                       "kerf sweep status noise.plan.json\n\n"
                       "Exit status 1 while cells are missing, or where some failed.",
                       [arguments, &context] { run_sweep_status(*arguments, context); });
  add_sweep_plan_file(verb, *arguments);
}

void add_sweep_merge(CLI::App& sweep, Context& context) {
  auto arguments = std::make_shared<SweepMergeArguments>();
  Verb verb =
      add_verb(sweep, context, "merge", "Put the shards of a sweep together: HDF5 and CSV, cell by cell",
               "kerf sweep merge noise.plan.json\n\n"
               "The same cells give the same bytes, whatever the number of shards, their order and restarts; "
               "times.csv\n"
               "alone differs. Exit status 1 if cells are missing or failed, or two shards have other "
               "numbers for one.",
               [arguments, &context] { run_sweep_merge(*arguments, context); });
  add_sweep_plan_file(verb, *arguments);
  verb.add_option("-o,--output", arguments->output,
                  "Folder of the result (default: NAME.merged beside the plan)");
  verb.add_flag("--force", arguments->force, "Replace an earlier result there");
}

}  // namespace kerf::bench

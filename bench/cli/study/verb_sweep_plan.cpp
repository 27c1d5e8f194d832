#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "files/for_terminal.h"
#include "files/in_gibibytes.h"
#include "files/whole_file.h"
#include "plan/plan_file.h"
#include "plan/sweep_file.h"
#include "run/run.h"
#include "run/timed_sample.h"
#include "study/swept_verbs.h"
#include "study/verb_sweep.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct SweepPlanArguments {
  std::string sweep;
  std::string output;
  std::size_t shards = 0;
  bool no_sample = false;
  bool list = false;
  bool force = false;
};

fs::path plan_file_of(const SweepPlanArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  fs::path file = fs::path(arguments.sweep).replace_extension();
  file += plan_ending;
  return file;
}

std::string in_hours(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.3g} s", seconds);
  if (seconds < 7200.0) return fmt::format("{:.3g} min", seconds / 60.0);
  return fmt::format("{:.3g} h", seconds / 3600.0);
}

void say_cost(const ExpectedCost& cost, const SweepPlan& plan, Context& context) {
  const std::uint64_t cells = plan.cells();
  context.say(
      fmt::format("  {:12} {} of one processor: {:.3g} ms a cell, the longest {:.3g} ms, by {} cells timed{}",
                  "time", in_hours(cost.whole_s(cells)), 1e3 * cost.cell_s, 1e3 * cost.longest_s, cost.timed,
                  cost.failed > 0 ? fmt::format(", {} of which failed", cost.failed) : ""));
  context.say(fmt::format("  {:12} {} a worker so far, {} MB at most", "memory",
                          in_gibibytes(cost.worker_bytes), plan.limits.megabytes));
}

/// Every cell in a line, which is never in memory with another one.
void list_cells(const SweepPlan& plan) {
  std::string lines = "cell,name";
  for (const SweepInput& input : plan.inputs) lines += "," + input.name;
  lines += '\n';
  const std::uint64_t cells = plan.cells();
  for (std::uint64_t number = 0; number < cells; ++number) {
    const SweepCell cell = plan.cell(number);
    lines += fmt::format("{},{}", number, plan.name_of(cell));
    for (const auto& value : cell.values()) lines += value ? "," + value_text(*value) : ",";
    lines += '\n';
    if (lines.size() < 65536) continue;
    print(for_terminal(lines));
    lines.clear();
  }
  print(for_terminal(lines));
}

void run_sweep_plan(const SweepPlanArguments& arguments, Context& context) {
  SweepPlan plan = read_sweep(arguments.sweep, swept_verbs());
  if (arguments.shards > 0) plan.shards = arguments.shards;
  const bool shards_open = plan.shards == 0;
  plan.shards = std::max<std::uint64_t>(plan.shards, 1);
  if (arguments.list) {
    list_cells(plan);
    return;
  }
  const fs::path file = plan_file_of(arguments);
  require_output(file, arguments.force);
  write_plan(file, plan, std::nullopt, arguments.force);
  PlanFile written = read_plan(file, swept_verbs());
  std::optional<ExpectedCost> cost;
  if (!arguments.no_sample) {
    const StopOnSignal signals;
    cost = timed_sample(written, {.program = {}, .plugins = context.plugins}, signals.requested());
    if (shards_open && cost->timed > 0) written.plan.shards = shards_for(*cost, plan.cells());
    write_plan(file, written.plan, cost, true);
  }
  context.result = {{"plan", file.string()},
                    {"sha256", written.sha256},
                    {"cells", plan.cells()},
                    {"shards", written.plan.shards}};
  context.say(fmt::format("{} cells of '{}' in {} shard{}", plan.cells(), plan.verb->name,
                          written.plan.shards, written.plan.shards == 1 ? "" : "s"));
  if (cost && cost->timed > 0) {
    say_cost(*cost, written.plan, context);
    context.result["expected_s"] = cost->whole_s(plan.cells());
    context.result["cell_s"] = cost->cell_s;
    context.result["worker_bytes"] = cost->worker_bytes;
  } else if (cost) {
    context.say(fmt::format(
        "  {:12} not known: the first cell that was tried did not end in time, or ended its worker", "time"));
  }
  context.say(fmt::format("  {:12} {}, SHA-256 {}", "plan", file.string(), written.sha256));
}

}  // namespace

void add_sweep_plan(CLI::App& sweep, Context& context) {
  auto arguments = std::make_shared<SweepPlanArguments>();
  Verb verb = add_verb(sweep, context, "plan", "Count and time the cells of a sweep, and write its plan",
                       "kerf sweep plan noise.toml\n"
                       "  kerf sweep plan noise.toml --list | head\n\n"
                       "Some cells are computed, evenly over all, to say what the sweep will take. The plan "
                       "has the hashes of\n"
                       "its recordings and its own: shards of another plan are told apart.",
                       [arguments, &context] { run_sweep_plan(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("SWEEP", arguments->sweep, "SWEEP.toml: the verb, and what is varied").required();
  verb.add_option("-o,--output", arguments->output, "The plan (default: NAME.plan.json beside SWEEP.toml)");
  verb.add_option("--shards", arguments->shards,
                  "Shards to be run (default: those of SWEEP.toml, or of half an hour each)")
      .within(1, 1'000'000);
  verb.add_flag("--no-sample", arguments->no_sample, "Compute no cell, and say nothing of time");
  verb.add_flag("--list", arguments->list,
                "Print every cell with its name and inputs as CSV, and write nothing");
  verb.add_flag("--force", arguments->force, "Replace a plan that is there");
}

}  // namespace kerf::bench

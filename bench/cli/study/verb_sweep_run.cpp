#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/core.h>
#include <sched.h>
#include <unistd.h>

#include <kerf/processes/helper.h>

#include "plan/plan_file.h"
#include "program/standard_streams.h"
#include "run/run.h"
#include "run/run_shard.h"
#include "run/serve_cells.h"
#include "study/swept_verbs.h"
#include "study/verb_sweep.h"

namespace kerf::bench {
namespace {

struct SweepRunArguments {
  std::string plan;
  std::string shard;
  std::string output;
  std::size_t jobs = 0;
  double stale_s = 60.0;
  bool failed = false;
};

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// "3/100", or "3" of as many as the plan has.
ShardName shard_named(const std::string& text, const PlanFile& plan, const char* where) {
  const auto slash = text.find('/');
  const auto shard = whole_number(text.substr(0, slash));
  const auto shards = slash == std::string::npos ? plan.plan.shards : whole_number(text.substr(slash + 1));
  if (!shard || !shards || *shards == 0)
    throw std::invalid_argument(
        fmt::format("{}: '{}' is no shard; expected i/n such as 3/100, i from 0 to n - 1", where, text));
  if (*shard >= *shards)
    throw std::invalid_argument(fmt::format("{}: there is no shard {} of {}; they are counted from 0 to {}",
                                            where, *shard, *shards, *shards - 1));
  return {.shard = *shard, .shards = *shards};
}

/// As asked for; else of a job in an array its part; else all.
ShardName requested_shard(const SweepRunArguments& arguments, const PlanFile& plan) {
  if (!arguments.shard.empty()) return shard_named(arguments.shard, plan, "--shard");
  const char* const task = std::getenv("SLURM_ARRAY_TASK_ID");
  if (task != nullptr) return shard_named(task, plan, "SLURM_ARRAY_TASK_ID");
  return {.shard = 0, .shards = 1};
}

/// Processors that this process may run on; under Slurm those that the job asked for.
std::size_t usual_workers() {
  const char* const given = std::getenv("SLURM_CPUS_PER_TASK");
  if (given != nullptr) return std::max<std::uint64_t>(whole_number(given).value_or(1), 1);
  if (std::getenv("SLURM_JOB_ID") != nullptr) return 1;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return static_cast<std::size_t>(std::max(1, CPU_COUNT(&set)));
}

std::string clock_text(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  const auto whole = static_cast<long>(seconds);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

void draw(const ShardProgress& progress, const ShardName& name) {
  if (::isatty(STDERR_FILENO) == 0 || progress.elapsed_s < 1.0) return;
  draw_error_text(fmt::format("\r{}: {} of {} cells, {} failed, {} left   ", name.in_words(), progress.done,
                              progress.cells, progress.failed, clock_text(progress.left_s())));
}

void say_shard(const ShardOutcome& outcome, const ShardName& name, Context& context) {
  const ShardProgress& progress = outcome.progress;
  context.result = {{"shard", name.shard},          {"shards", name.shards},
                    {"cells", progress.cells},      {"done", progress.done},
                    {"failed", progress.failed},    {"computed", progress.computed},
                    {"complete", outcome.complete}, {"elapsed_s", progress.elapsed_s},
                    {"cells_s", outcome.cells_s},   {"file", outcome.file.string()}};
  context.say(fmt::format("{}: {} of {} cells are there, {} of them failed; {} computed in {:.3g} s; {}",
                          name.in_words(), progress.done, progress.cells, progress.failed, progress.computed,
                          progress.elapsed_s, outcome.file.string()));
  if (!outcome.complete) {
    context.say("stopped; run it again to go on from there");
    context.exit = Exit::to_be_continued;
  } else if (progress.failed > 0) {
    context.exit = Exit::check_failed;
  }
}

void run_sweep_shard(const SweepRunArguments& arguments, Context& context) {
  const StopOnSignal signals(StopOnSignal::Also::user_signal);
  const PlanFile plan = read_plan(arguments.plan, swept_verbs());
  ShardRunOptions options;
  options.name = requested_shard(arguments, plan);
  options.folder = arguments.output.empty() ? plan.shards_folder() : std::filesystem::path(arguments.output);
  options.workers = arguments.jobs > 0 ? arguments.jobs : usual_workers();
  options.worker.plugins = context.plugins;
  options.failed_again = arguments.failed;
  options.lock.silence = std::chrono::milliseconds(std::llround(1e3 * arguments.stale_s));
  options.lock.stopped = [&] { return signals.requested().load(); };
  options.lock.tell = [](const std::string& line) { note(line); };
  options.progress = [&](const ShardProgress& progress) { draw(progress, options.name); };
  const ShardOutcome outcome = run_shard(plan, options, signals.requested());
  if (::isatty(STDERR_FILENO) != 0) draw_error_text(fmt::format("\r{:79}\r", ""));
  say_shard(outcome, options.name, context);
}

}  // namespace

void add_sweep_run(CLI::App& sweep, Context& context) {
  auto arguments = std::make_shared<SweepRunArguments>();
  Verb verb = add_verb(
      sweep, context, "run", "Compute a shard of a sweep, or go on with it",
      "kerf sweep run noise.plan.json -j 2\n"
      "  kerf sweep run noise.plan.json --shard 3/100\n\n"
      "Without --shard, of a job in a Slurm array the shard of its task, else all cells. What is there is "
      "not\n"
      "computed again. A cell that crashes or takes too long is recorded with its reason: exit status 1.\n"
      "SIGTERM, SIGINT and SIGUSR1 end it with exit status 75; run again, it goes on from there.",
      [arguments, &context] { run_sweep_shard(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("PLAN", arguments->plan, "NAME.plan.json of 'kerf sweep plan'").required();
  verb.add_option("--shard", arguments->shard, "i/n, i from 0 to n - 1, or i of as many as the plan says");
  verb.add_option("-j,--jobs", arguments->jobs,
                  "Workers (default: as many as processors were given to it, under Slurm those of the task)")
      .within(1, 1024);
  verb.add_option("-o,--output", arguments->output,
                  "Folder of the shards (default: NAME.shards beside the plan)");
  verb.add_flag("--failed", arguments->failed, "Compute cells again that failed before");
  verb.add_option("--stale", arguments->stale_s,
                  "How long another machine that has this shard may give no sign of life [s]")
      .within(0.0, 86400.0)
      .with_default();
}

void add_sweep_worker(CLI::App& sweep, Context& context) {
  auto plan = std::make_shared<std::string>();
  Verb verb = add_verb(sweep, context, "worker", "What 'kerf sweep run' starts", "kerf sweep worker PLAN",
                       [plan] { serve_cells(*plan, processes::first_descriptor, swept_verbs()); });
  verb.hidden().takes_laws(context);
  verb.add_option("PLAN", *plan, "The plan").required();
}

}  // namespace kerf::bench

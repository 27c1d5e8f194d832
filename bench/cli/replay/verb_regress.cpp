#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "program/verbs.h"
#include "recordings/provenance.h"
#include "regress/context.h"
#include "regress/junit.h"
#include "regress/regress_page.h"
#include "regress/renderers/recorded_table.h"
#include "regress/renderers/step_cost.h"
#include "regress/run.h"
#include "regress/stored/suite_lock.h"
#include "regress/stored/summary.h"

namespace kerf::bench {
namespace {

struct RegressVerbArguments {
  std::string action;
  std::string suite;
  std::string one;
  SuiteOptions options;
  std::string junit;
  std::string output;
  std::string reason;
  bool no_cost = false;
  bool yes = false;
};

void say_case(const RegressionOutcome& one, Context& context) {
  if (!one.error.empty()) {
    context.say(fmt::format("  {:24} ERROR\n      {}", one.about.name, one.error));
    return;
  }
  if (one.left_out) return context.say(fmt::format("  {:24} left out", one.about.name));
  const std::string cost =
      one.tick_cost ? fmt::format("tick cost {:.3g}", *one.tick_cost) : step_cost_in_words(one.got);
  context.say(fmt::format("  {:24} {:6}  {:>6} ticks  largest difference {:10}  {}", one.about.name,
                          one.passed() ? "passed" : "FAILED", one.comparison.got_rows,
                          largest_in_words(one.comparison), cost));
  if (!one.note.empty()) context.say(fmt::format("      {}", one.note));
  if (one.passed()) return;
  for (const std::string& message : one.messages) context.say(fmt::format("      {}", message));
  context.say(fmt::format("      {}", one.why));
  std::string table = context_table(one);
  if (!table.empty()) table.pop_back();
  if (!table.empty()) context.say(table);
}

void refuse(bool given, std::string_view option, std::string_view action) {
  if (given) throw std::invalid_argument(fmt::format("{} is for 'kerf regress {}'", option, action));
}

void require_outputs(const RegressVerbArguments& arguments) {
  refuse(!arguments.reason.empty(), "--reason", "update");
  refuse(arguments.yes, "--yes", "update");
  if (!arguments.junit.empty()) require_output(arguments.junit, true);
  if (!arguments.output.empty())
    require_output(std::filesystem::path(arguments.output) / "regress.json", true);
}

/// The suite; a build server is told of one that cannot be read, too.
Suite suite_to_run(const RegressVerbArguments& arguments) {
  require_outputs(arguments);
  try {
    return read_suite(arguments.suite);
  } catch (const std::exception& error) {
    if (!arguments.junit.empty())
      write_whole_file(arguments.junit, junit_xml(arguments.suite, error.what()), schema::Existing::replace);
    throw;
  }
}

void write_page(const Suite& suite, const SuiteOutcome& outcome, const std::string& folder,
                Context& context) {
  WholeFolder whole(folder, schema::Existing::replace);
  write_regress_page(suite, outcome, whole.path());
  whole.commit();
  context.say(fmt::format("regress.html, regress.json and the pictures are in {}", folder));
}

void run_cases(const RegressVerbArguments& arguments, const Suite& suite, Context& context) {
  const SuiteLock lock(suite.file, SuiteLock::To::read);
  const SuiteOutcome outcome = run_suite(suite, arguments.options);
  context.result = outcome_as_json(suite, outcome);
  for (const RegressionOutcome& one : outcome.cases) say_case(one, context);
  for (const std::string& name : outcome.dropped) {
    context.say(fmt::format("  {:24} FAILED", name));
    context.say(
        "      its forces are stored, and the suite has no such case any more; 'kerf regress update' removes "
        "them");
  }
  for (const std::string& one : outcome.notes) note(one);
  const std::size_t all = outcome.cases.size() + outcome.dropped.size() - outcome.left_out();
  if (outcome.left_out() > 0)
    context.say(fmt::format(
        "{} of {} cases left out: what they follow from is as it was when their forces were stored",
        outcome.left_out(), outcome.cases.size()));
  context.say(outcome.failed() == 0
                  ? fmt::format("{}: all {} cases passed, in {:.2f} s", suite.name, all, outcome.seconds)
                  : fmt::format("{}: {} of {} cases did not pass", suite.name, outcome.failed(), all));
  if (!arguments.junit.empty())
    write_whole_file(arguments.junit, junit_xml(suite, outcome, arguments.output), schema::Existing::replace);
  if (!arguments.output.empty()) {
    write_page(suite, outcome, arguments.output, context);
  }
  if (outcome.failed() > 0) context.exit = Exit::check_failed;
  if (outcome.errors() < all || all == 0) return;
  // Nothing was compared, which is no verdict on any force.
  note(outcome.cases.front().error);
  context.exit = Exit::bad_input;
}

std::string_view name_of(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::added:
      return "new";
    case ChangeKind::changed:
      return "changes";
    case ChangeKind::removed:
      return "goes";
    case ChangeKind::impossible:
      return "fails";
    case ChangeKind::unchanged:
      break;
  }
  return "stays";
}

/// Asks whoever has seen what would change.
bool confirmed(bool yes, Context& context) {
  if (yes) return true;
  if (context.json || ::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0) return false;
  print("Store this? [y/N] ");
  std::string answer;
  return std::getline(std::cin, answer) && (answer == "y" || answer == "yes");
}

void update_forces(const RegressVerbArguments& arguments, const Suite& suite, Context& context) {
  refuse(!arguments.junit.empty(), "--junit", "run");
  if (arguments.reason.find_first_not_of(" \t\r\n") == std::string::npos)
    throw std::invalid_argument("say why the forces change: --reason WHY");
  if (!arguments.output.empty())
    require_output(std::filesystem::path(arguments.output) / "regress.json", true);
  refuse(arguments.options.changed, "--changed", "run");
  const SuiteLock lock(suite.file, SuiteLock::To::store);
  const auto changes = plan_update(suite, arguments.options);
  context.result = {{"suite", suite.file.string()}, {"stored", suite.stored.string()}, {"written", false}};
  context.result["changes"] = nlohmann::ordered_json::array();
  for (const StoredChange& one : changes) {
    if (!one.asked) continue;
    context.result["changes"].push_back(
        {{"name", one.name}, {"change", name_of(one.kind)}, {"what", one.what}, {"why", one.why}});
    context.say(fmt::format("  {:24} {:8} {}{}{}", one.name, name_of(one.kind), one.what,
                            one.why.empty() ? "" : "; ", one.why));
    if (one.kind == ChangeKind::impossible) context.exit = Exit::check_failed;
  }
  const std::string besides = completes_anything(suite, changes);
  if (!changes_anything(changes)) {
    context.say(fmt::format("{} stays as it is", besides.empty() ? suite.stored.string() : "every force"));
    if (besides.empty()) return;
    context.say(besides);
  }
  if (!arguments.output.empty()) write_page(suite, what_changes(changes), arguments.output, context);
  if (!confirmed(arguments.yes, context))
    throw std::invalid_argument(
        fmt::format("{} was not touched; --yes stores what is shown", suite.stored.string()));
  write_update(suite, changes, arguments.reason);
  context.result["written"] = true;
  context.say(fmt::format("written: {} and {}", suite.stored.string(), summary_file(suite).string()));
}

/// The motion of a case as a renderer reads it.
void write_trajectory(const RegressVerbArguments& arguments, Context& context) {
  if (arguments.one.empty() || arguments.output.empty())
    throw std::invalid_argument("expected kerf regress trajectory SUITE CASE -o FILE.csv or FILE.h5");
  require_output(arguments.output, true);
  const RegressionCase one = only(read_suite(arguments.suite), {arguments.one}).cases.front();
  if (!one.error.empty()) throw std::invalid_argument(one.error);
  const SampledMotion path = path_of(one);
  const TrajectoryColumns columns{axes_of(one), one.outside ? one.outside->quaternion : ""};
  if (is_recording(arguments.output)) {
    schema::Recording recording = trajectory_recording(path, columns);
    recording.header = schema::new_header(software());
    if (one.outside) {
      recording.header.scene_properties["sign"] = one.outside->sign;
      if (!one.outside->frame.empty()) recording.header.scene_properties["frame"] = one.outside->frame;
      if (!columns.quaternion.empty()) recording.header.scene_properties["quaternion"] = columns.quaternion;
    }
    add_history(recording.header, fmt::format("kerf regress trajectory, case '{}'", one.name));
    schema::write_recording(arguments.output, recording);
  } else {
    write_whole_file(arguments.output, trajectory_csv(path, columns), schema::Existing::replace);
  }
  context.result = {
      {"suite", arguments.suite}, {"case", one.name}, {"ticks", path.ticks()}, {"file", arguments.output}};
  context.say(fmt::format("{}: {} ticks", arguments.output, path.ticks()));
}

void run_regress(RegressVerbArguments& arguments, Context& context) {
  arguments.options.tick_costs = !arguments.no_cost;
  refuse(!arguments.one.empty() && arguments.action != "trajectory", "CASE", "trajectory");
  if (arguments.action == "trajectory") {
    write_trajectory(arguments, context);
  } else if (arguments.action == "run") {
    run_cases(arguments, suite_to_run(arguments), context);
  } else {
    update_forces(arguments, read_suite(arguments.suite), context);
  }
}

}  // namespace

void add_regress(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<RegressVerbArguments>();
  Verb verb =
      add_verb(app, context, "regress", "Compare rendered forces with stored ones, tick by tick",
               "kerf regress update suite.toml --reason 'first forces' --yes\n"
               "  kerf regress run suite.toml --junit regress.xml -o regress\n\n"
               "A suite names laws, trajectories and tolerances; its forces are stored beside it, in\n"
               "suite.h5. 'run' exits with 1 if a force, the number of samples or the cost of a tick is\n"
               "not as it was. A case may name a program of yours in place of a law; 'trajectory SUITE CASE\n"
               "-o t.csv' (or t.h5) writes what it is given. 'update' says what would change and why, and\n"
               "asks before it writes.\n"
               "docs/regress.md says more.",
               [arguments, &context] { run_regress(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("ACTION", arguments->action, "run, update or trajectory")
      .required()
      .one_of({"run", "update", "trajectory"});
  verb.add_option("SUITE", arguments->suite, "The suite, SUITE.toml").required();
  verb.add_option("CASE", arguments->one, "Of 'trajectory': the case whose motion is written");
  verb.add_option("--only", arguments->options.only, "This case alone; may be repeated").one_value_each();
  verb.add_flag("--changed", arguments->options.changed,
                "Only cases whose law, renderer, trajectory or kerf is not the one of the stored forces");
  verb.add_option("-j,--jobs", arguments->options.jobs,
                  "Cases at a time; those whose cost is measured run alone")
      .with_default();
  verb.add_option("--junit", arguments->junit, "Write the results as JUnit XML");
  verb.add_option("-o,--output", arguments->output,
                  "Folder for regress.html, regress.json and pictures of what differs; of 'trajectory' "
                  "FILE.csv or FILE.h5");
  verb.add_flag("--no-cost", arguments->no_cost, "Do not measure what a tick costs");
  verb.add_option("--reason", arguments->reason, "Why the forces change; kept in the file");
  verb.add_flag("--yes", arguments->yes, "Store what changes without asking");
}

}  // namespace kerf::bench
